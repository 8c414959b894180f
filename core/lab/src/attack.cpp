// SPDX-License-Identifier: MIT
// The attacks by name: checks what the command line says, then calls the one meant.
#include <cstdio>

#include "quadmark/lab/attacks.h"

namespace quadmark::lab {
namespace {

std::string shortNumber(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

Status checkAmount(const AttackSpec& spec, const char* meaning, double low, double high) {
  if (spec.amount >= low && spec.amount <= high) return okStatus();  // refuses NaN too
  return Error{ErrorCode::badOption, spec.kind + ": amount " + shortNumber(spec.amount) + " is outside " +
                                         shortNumber(low) + ".." + shortNumber(high) + " (" + meaning + ")"};
}

/// The place of spec.variant in `names`; an empty one is the first.
Result<int> chooseVariant(const AttackSpec& spec, const std::vector<std::string>& names) {
  if (spec.variant.empty()) return 0;
  std::string known;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (spec.variant == names[i]) return static_cast<int>(i);
    known += (i ? ", " : "") + names[i];
  }
  return Error{ErrorCode::badOption, spec.kind + ": variant \"" + spec.variant + "\" is not one of " + known};
}

Result<Mesh> attackAffine(const Mesh& mesh, const AttackSpec& spec) {
  const Result<Affine> map = paperAffine(spec.variant.empty() ? "CB" : spec.variant);
  if (!map) return map.error();
  return affine(mesh, *map);
}

Result<Mesh> attackReorder(const Mesh& mesh, const AttackSpec& spec) {
  return reorder(mesh, spec.seed);
}

Result<Mesh> attackCrop(const Mesh& mesh, const AttackSpec& spec) {
  const Status range = checkAmount(spec, "share of the vertices to remove", 0, 1);
  if (!range) return range.error();
  const Result<int> axis = chooseVariant(spec, {"y", "x", "z", "random"});
  if (!axis) return axis.error();
  constexpr int kAxes[] = {1, 0, 2, 3};
  return crop(mesh, spec.amount, kAxes[*axis], spec.seed);
}

Result<Mesh> attackNoise(const Mesh& mesh, const AttackSpec& spec) {
  const Status range = checkAmount(spec, "largest displacement, fraction of the bounding-box diagonal", 0, 1);
  if (!range) return range.error();
  if (spec.kind == "noise") return noise(mesh, spec.amount, spec.seed);
  return localNoise(mesh, spec.amount, 0.5, spec.seed);
}

Result<Mesh> attackQuantize(const Mesh& mesh, const AttackSpec& spec) {
  const Status range = checkAmount(spec, "bits per coordinate", 1, 30);
  if (!range) return range.error();
  const int bits = static_cast<int>(spec.amount);
  if (bits != spec.amount)
    return Error{ErrorCode::badOption,
                 "quantize: amount " + shortNumber(spec.amount) + " is not a whole number of bits"};
  const Result<int> grid = chooseVariant(spec, {"common", "per-axis"});
  if (!grid) return grid.error();
  return quantize(mesh, bits, *grid == 0 ? Grid::common : Grid::perAxis);
}

Result<Mesh> attackSmooth(const Mesh& mesh, const AttackSpec& spec) {
  const Status range = checkAmount(spec, "lambda", 0, 1);
  if (!range) return range.error();
  if (spec.iterations < 1 || spec.iterations > 10000)
    return Error{ErrorCode::badOption,
                 "smooth: iterations " + std::to_string(spec.iterations) + " is outside 1..10000"};
  const Result<int> method = chooseVariant(spec, {"taubin", "laplacian"});
  if (!method) return method.error();
  return *method == 0 ? smoothTaubin(mesh, spec.amount, spec.iterations)
                      : smoothLaplacian(mesh, spec.amount, spec.iterations);
}

Result<Mesh> attackSimplify(const Mesh& mesh, const AttackSpec& spec) {
  const Status range = checkAmount(spec, "share to remove", 0, 1);
  if (!range) return range.error();
  const Result<int> method = chooseVariant(spec, {"meshopt", "qem"});
  if (!method) return method.error();
  return *method == 0 ? simplifyMeshopt(mesh, 1 - spec.amount) : simplifyQem(mesh, 1 - spec.amount);
}

Result<Mesh> attackDeform(const Mesh& mesh, const AttackSpec& spec) {
  const Status range = checkAmount(spec, "radians", -6.5, 6.5);
  if (!range) return range.error();
  return deform(mesh, spec.amount, spec.seed);
}

struct Kind {
  const char* name;
  const char* description;
  Result<Mesh> (*run)(const Mesh&, const AttackSpec&);
};

constexpr Kind kKinds[] = {
    {"affine", "affine map: variant R, NS, RE, S, SH or CB (all of them)", attackAffine},
    {"reorder", "permute vertices, faces and first corners", attackReorder},
    {"crop", "remove the share `amount` of the vertices along y, x, z or a random axis", attackCrop},
    {"noise", "uniform noise of `amount` bounding-box diagonals per coordinate", attackNoise},
    {"local-noise", "the same noise on one half of the model", attackNoise},
    {"quantize", "round to `amount` bits: variant common (one step for all axes) or per-axis", attackQuantize},
    {"smooth", "`iterations` steps with lambda = `amount`: variant taubin or laplacian", attackSmooth},
    {"simplify", "remove the share `amount`: variant meshopt (triangles) or qem (vertices)", attackSimplify},
    {"deform", "bend and twist one half by up to `amount` radians", attackDeform},
};

}  // namespace

Result<Mesh> attack(const Mesh& mesh, const AttackSpec& spec) {
  std::string known;
  for (const Kind& kind : kKinds) {
    known += (known.empty() ? "" : ", ") + std::string(kind.name);
    if (spec.kind != kind.name) continue;
    Result<Mesh> result = kind.run(mesh, spec);
    if (result && result->faceCount() == 0 && mesh.faceCount() != 0)
      return Error{ErrorCode::badMesh, spec.kind + ": amount " + shortNumber(spec.amount) + " leaves no face"};
    return result;
  }
  return Error{ErrorCode::badOption, "attack \"" + spec.kind + "\" is not one of " + known};
}

std::vector<AttackInfo> attackKinds() {
  std::vector<AttackInfo> kinds;
  for (const Kind& kind : kKinds) kinds.push_back({kind.name, kind.description});
  return kinds;
}

}  // namespace quadmark::lab
