// SPDX-License-Identifier: MIT
#include "models.h"

#include <cstdlib>
#include <utility>

#include "quadmark/io/model.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "read_file.h"

namespace quadmark::bench {
namespace {

Result<Mesh> generated(const std::string& name) {
  if (const std::size_t at = name.find_last_of("@~"); at != name.npos) {
    const auto whole = generated(name.substr(0, at));
    if (!whole) return whole.error();
    const double amount = std::strtod(name.c_str() + at + 1, nullptr);
    if (name[at] == '@') return lab::simplifyQem(*whole, amount);
    return lab::smoothLaplacian(*whole, 0.03, static_cast<int>(amount));
  }
  const std::size_t colon = name.find(':'), second = name.find(':', colon + 1);
  const std::uint64_t seed = second == name.npos ? 1 : std::strtoull(name.c_str() + second + 1, nullptr, 10);
  return lab::generate(name.substr(0, colon), std::strtoull(name.c_str() + colon + 1, nullptr, 10), seed);
}

}  // namespace

Result<NamedModel> loadModel(const std::string& name) {
  NamedModel out;
  out.name = name.substr(name.rfind('/') + 1);
  if (name.find(':') != name.npos) {
    auto mesh = generated(name);
    if (!mesh) return mesh.error();
    out.mesh = std::move(*mesh);
    return out;
  }
  auto bytes = readFile(name);
  if (!bytes) return bytes.error();
  out.bytes = std::move(*bytes);
  const auto uris = externalUris(out.bytes);
  if (!uris) return uris.error();
  Resources resources;
  for (const std::string& uri : *uris) {
    auto resource = readFile(name.substr(0, name.rfind('/') + 1) + uri);
    if (!resource) return resource.error();
    resources[uri] = std::move(*resource);
  }
  auto model = readModel(out.bytes, resources);
  if (!model) return Error{model.error().code, out.name + ": " + model.error().message};
  out.mesh = std::move((*model)->mesh());
  return out;
}

Result<std::vector<std::uint8_t>> toGlb(const NamedModel& model, const std::vector<double>& positions) {
  if (model.bytes.size() > 4 && std::string(model.bytes.begin(), model.bytes.begin() + 4) == "glTF") {
    auto file = readModel(model.bytes);
    if (!file) return file.error();
    auto patched = (*file)->patch(model.bytes, {}, positions);
    if (!patched) return patched.error();
    return std::move(patched->bytes);
  }
  Mesh mesh = model.mesh;
  mesh.positions = positions;
  return lab::writeGlb(mesh);
}

}  // namespace quadmark::bench
