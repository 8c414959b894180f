// SPDX-License-Identifier: MIT
#include "robust_attacks.h"

#include <cstdio>
#include <cstdlib>
#include <set>

#include "quadmark/lab/attacks.h"

namespace quadmark::bench {
namespace {

Mesh quantized(const Mesh& m, int bits) {
  return lab::quantize(m, bits, lab::Grid::common);
}

// The geometry of `gltf-transform optimize`: everything that costs less than 1e-4 of the extent collapses.
Mesh optimized(const Mesh& m) {
  return lab::simplifyMeshopt(m, 0, nullptr, 1e-4);
}

// Coordinates as text of six significant digits.
Mesh sixDigits(Mesh m) {
  for (double& x : m.positions) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", x);
    x = std::strtod(text, nullptr);
  }
  roundToPrecision(m);
  return m;
}

// Gaussian-like noise of an object that fills 1 / scale of a scene quantized to 14 bits: 8.4e-4 of its own largest side
// at 1/20 (measured with gltf-transform optimize); as uniform noise of that deviation, relative to the diagonal.
Mesh inScene(const Mesh& m, double scale) {
  return lab::noise(m, 1.039e-3 * scale / 20, 3);
}

}  // namespace

std::vector<NamedAttack> robustAttacks() {
  std::vector<NamedAttack> list;
  const auto add = [&](std::string name, std::function<Mesh(const Mesh&)> apply) {
    list.push_back({std::move(name), std::move(apply)});
  };
  add("none", [](const Mesh& m) { return m; });
  add("reorder", [](const Mesh& m) { return lab::reorder(m, 5); });
  add("affine", [](const Mesh& m) { return lab::affine(m, *lab::paperAffine("CB")); });
  add("6 digits", sixDigits);
  for (const auto& [name, a] :
       {std::pair{"noise 2e-5", 2e-5}, {"noise 1e-4", 1e-4}, {"noise 3e-4", 3e-4}, {"noise 1e-3", 1e-3}})
    add(name, [amplitude = a](const Mesh& m) { return lab::noise(m, amplitude, 3); });
  for (const int bits : {16, 14, 12, 11, 10, 9, 8})
    add("q" + std::to_string(bits), [bits](const Mesh& m) { return quantized(m, bits); });
  add("lap .03x10", [](const Mesh& m) { return lab::smoothLaplacian(m, 0.03, 10); });
  add("lap .03x30", [](const Mesh& m) { return lab::smoothLaplacian(m, 0.03, 30); });
  add("crop 50", [](const Mesh& m) { return lab::crop(m, 0.5); });
  add("crop 80", [](const Mesh& m) { return lab::crop(m, 0.8); });
  add("crop 92", [](const Mesh& m) { return lab::crop(m, 0.92); });
  for (const int keep : {90, 70, 50, 30})
    add("s." + std::to_string(keep / 10), [keep](const Mesh& m) { return lab::simplifyMeshopt(m, keep / 100.0); });
  for (const int keep : {90, 70, 50})
    add("s." + std::to_string(keep / 10) + "+q14",
        [keep](const Mesh& m) { return quantized(lab::simplifyMeshopt(m, keep / 100.0), 14); });
  add("opt+q14", [](const Mesh& m) { return quantized(optimized(m), 14); });
  add("opt+q12", [](const Mesh& m) { return quantized(optimized(m), 12); });
  add("s.9+q12", [](const Mesh& m) { return quantized(lab::simplifyMeshopt(m, 0.9), 12); });
  add("s.7+q12", [](const Mesh& m) { return quantized(lab::simplifyMeshopt(m, 0.7), 12); });
  add("aff+s.85+q14",
      [](const Mesh& m) { return quantized(lab::simplifyMeshopt(lab::affine(m, *lab::paperAffine("CB")), 0.85), 14); });
  add("crop 50+s.7", [](const Mesh& m) { return lab::simplifyMeshopt(lab::crop(m, 0.5), 0.7); });
  add("qem .9", [](const Mesh& m) { return lab::simplifyQem(m, 0.9); });
  add("qem .8", [](const Mesh& m) { return lab::simplifyQem(m, 0.8); });
  add("qem .7", [](const Mesh& m) { return lab::simplifyQem(m, 0.7); });
  add("scene 1/20", [](const Mesh& m) { return inScene(m, 20); });
  add("scene 1/100", [](const Mesh& m) { return inScene(m, 100); });
  return list;
}

bool isForImages(const std::string& attack) {
  static const std::set<std::string> names = {"none", "reorder", "affine", "6 digits", "noise 2e-5", "noise 1e-4",
                                              "noise 3e-4", "q16", "q14", "q12", "q11", "q10", "crop 50", "s.9", "s.7"};
  return names.count(attack) == 1;
}

}  // namespace quadmark::bench
