// SPDX-License-Identifier: MIT
// Binding table of the lab module: attacks and generated models, never loaded by the product itself.
#include <emscripten/bind.h>

#include "convert.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"

namespace quadmark::wasm {
namespace {

val sizesOf(const Mesh& mesh) {
  val sizes = val::object();
  sizes.set("vertices", static_cast<double>(mesh.vertexCount()));
  sizes.set("faces", static_cast<double>(mesh.faceCount()));
  return sizes;
}

val written(const Mesh& mesh, const std::string& format) {
  return arrayFrom<std::uint8_t>(format == "glb" ? lab::writeGlb(mesh) : lab::writePly(mesh));
}

Result<std::uint64_t> seedFrom(const val& request) {
  const auto seed = integerFrom(request, "seed", 1, 0, 9007199254740991.0);  // 2^53 - 1: exact in JavaScript
  if (!seed) return seed.error();
  return static_cast<std::uint64_t>(*seed);
}

/// request: { kind, amount?, variant?, iterations?, seed?, format: "ply" | "glb" }
/// -> { bytes, before: { vertices, faces }, after: { vertices, faces } }
val attackModel(const val& file, const val& resourceEntries, const val& request) {
  lab::AttackSpec spec;
  spec.kind = request["kind"].as<std::string>();
  if (isPresent(request["variant"])) spec.variant = request["variant"].as<std::string>();
  const auto amount = numberFrom(request, "amount", spec.amount);
  if (!amount) return failure(amount.error());
  const auto iterations = integerFrom(request, "iterations", spec.iterations, 1, 10000);
  if (!iterations) return failure(iterations.error());
  const auto seed = seedFrom(request);
  if (!seed) return failure(seed.error());
  spec.amount = *amount;
  spec.iterations = static_cast<int>(*iterations);
  spec.seed = *seed;

  const std::vector<std::uint8_t> bytes = bytesFrom(file);
  auto model = readModel(bytes, resourcesFrom(resourceEntries));
  if (!model) return failure(model.error());
  (*model)->mesh().gridOf.clear();  // what attacks write are floats
  auto attacked = lab::attack((*model)->mesh(), spec);
  if (!attacked) return failure(attacked.error());
  val result = val::object();
  result.set("before", sizesOf((*model)->mesh()));
  result.set("after", sizesOf(*attacked));
  result.set("bytes", written(*attacked, request["format"].as<std::string>()));
  return result;
}

/// request: { name, vertices?, seed?, format: "ply" | "glb" } -> { bytes, after: { vertices, faces } }
val generateModel(const val& request) {
  const auto vertices = integerFrom(request, "vertices", 35000, 4, 20e6);
  if (!vertices) return failure(vertices.error());
  const auto seed = seedFrom(request);
  if (!seed) return failure(seed.error());
  auto mesh = lab::generate(request["name"].as<std::string>(), static_cast<std::size_t>(*vertices), *seed);
  if (!mesh) return failure(mesh.error());
  val result = val::object();
  result.set("after", sizesOf(*mesh));
  result.set("bytes", written(*mesh, request["format"].as<std::string>()));
  return result;
}

/// [{ kind, description }, ...]
val listAttackKinds() {
  val list = val::array();
  for (const lab::AttackInfo& info : lab::attackKinds()) {
    val entry = val::object();
    entry.set("kind", info.kind);
    entry.set("description", info.description);
    list.call<void>("push", entry);
  }
  return list;
}

}  // namespace

EMSCRIPTEN_BINDINGS(quadmark_lab) {
  installNewHandler();
  emscripten::function("attack", &attackModel);
  emscripten::function("generate", &generateModel);
  emscripten::function("attackKinds", &listAttackKinds);
}

}  // namespace quadmark::wasm
