// SPDX-License-Identifier: MIT
// Keys, payloads and generated meshes that the tests of the scheme share, and what they ask of a reading.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "quadmark/adjacency.h"
#include "quadmark/embed.h"
#include "quadmark/extract.h"
#include "quadmark/lab/attacks.h"
#include "quadmark/lab/generate.h"
#include "quadmark/metrics.h"
#include "quadmark/quadmark.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer)
#define QM_SLOW_BUILD 1
#endif
#endif
#if !defined(QM_SLOW_BUILD) && (defined(__SANITIZE_ADDRESS__) || defined(__EMSCRIPTEN__) || !defined(__OPTIMIZE__))
#define QM_SLOW_BUILD 1
#endif

namespace quadmark::test {

/// How many repetitions a heavy loop makes: `full` in an optimised native build, a tenth (at least 2) under sanitizers,
/// unoptimised and as wasm. QUADMARK_FULL_TESTS=1 makes it `full` everywhere.
inline int repetitions(int full) {
#ifdef QM_SLOW_BUILD
  const char* asked = std::getenv("QUADMARK_FULL_TESTS");
  if (asked == nullptr || *asked != '1') return full / 10 < 2 ? 2 : full / 10;
#endif
  return full;
}

inline Key testKey(std::uint32_t width, std::uint32_t height, int L = 2, std::uint8_t seed = 1) {
  KeyRequest request;
  for (std::size_t i = 0; i < request.secret.size(); ++i)
    request.secret[i] = static_cast<std::uint8_t>(seed * 37 + 11 * i);
  request.owner = "tests";
  request.params.width = width;
  request.params.height = height;
  request.params.L1 = L;
  return makeKey(request).value();
}

inline Key idKey(std::uint8_t seed = 1) {
  Key key = testKey(64, 1, 2, seed);
  key.params.payload = PayloadType::id;
  return key;
}

/// A key whose secret has nothing to do with testKey()'s, one per number.
inline Key strangersKey(Key key, std::uint32_t number) {
  const std::string text = "stranger " + std::to_string(number);
  const Digest digest = sha256({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  std::copy(digest.begin(), digest.end(), key.secret.begin());
  return key;
}

/// A picture as logos are: long runs, more light than dark, no symmetry.
inline BitImage logo(std::uint32_t width, std::uint32_t height) {
  BitImage image{width, height, std::vector<std::uint8_t>(std::size_t{width} * height, 0)};
  for (std::uint32_t y = 0; y < height; ++y)
    for (std::uint32_t x = 0; x < width; ++x) {
      const double u = (x + 0.5) / width - 0.45, v = (y + 0.5) / height - 0.5, r2 = u * u + v * v;
      image.bits[std::size_t{y} * width + x] =
          (r2 < 0.16 && r2 > 0.07) || (u > 0.1 && v > 0.1 && u - v < 0.12 && v - u < 0.12);
    }
  return image;
}

inline Mesh withPositions(Mesh mesh, std::vector<double> positions) {
  mesh.positions = std::move(positions);
  return mesh;
}

inline Mesh asFloat64(Mesh mesh) {
  mesh.precision = Precision::float64;
  return mesh;
}

/// The cells that the embedder finds, and the welded positions it leaves.
struct Searched : SearchResult {
  std::vector<double> positions;
};
inline Searched searched(const Mesh& mesh, const PaperParams& params = {}) {
  WeldedMesh welded = weld(mesh);
  SearchResult found = searchCells(mesh, welded, params, boundingDiagonal(mesh), roundingOf(mesh.precision));
  return {std::move(found), std::move(welded.positions)};
}

/// Welds a mesh as it stands and reads it.
inline Extraction readMark(const Mesh& mesh, const Key& key, const ExtractOptions& options = {}) {
  const WeldedMesh welded = weld(mesh);
  return extractMesh(welded, welded.positions, roundingOf(mesh.precision, welded), key, options);
}

/// Every bit right, none erased.
inline ::testing::AssertionResult isExact(const Extraction& read, const std::vector<std::uint8_t>& bits) {
  if (read.bits.size() != bits.size() || read.erased.size() != bits.size())
    return ::testing::AssertionFailure() << read.bits.size() << " bits read, " << bits.size() << " expected";
  std::size_t wrong = 0, unread = 0;
  for (std::size_t i = 0; i < bits.size(); ++i) {
    unread += read.erased[i] != 0;
    wrong += read.erased[i] == 0 && read.bits[i] != bits[i];
  }
  if (wrong + unread == 0) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << wrong << " wrong and " << unread << " unread of " << bits.size() << " bits, "
                                       << read.cells << " cells voted in " << read.passes << " passes";
}

inline ::testing::AssertionResult readsExactly(const Mesh& mesh, const Key& key,
                                               const std::vector<std::uint8_t>& bits) {
  return isExact(readMark(mesh, key), bits);
}

/// Marks a mesh; a refusal is a test failure and gives the mesh back unmarked.
inline Mesh marked(const Mesh& mesh, const Key& key, const std::vector<std::uint8_t>& bits, MarkedMesh* out = nullptr) {
  Result<MarkedMesh> result = embedMesh(mesh, bits, key);
  if (!result) {
    ADD_FAILURE() << "embedding refused: " << errorCodeName(result.error().code) << ", " << result.error().message;
    return mesh;
  }
  Mesh copy = withPositions(mesh, result->positions);
  if (out != nullptr) *out = std::move(*result);
  return copy;
}

inline const std::vector<std::string>& affineNames() {
  static const std::vector<std::string> names = {"R", "NS", "RE", "S", "SH", "CB"};
  return names;
}

inline Mesh mapped(const Mesh& mesh, const std::string& name) { return lab::affine(mesh, *lab::paperAffine(name)); }

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// Every kind of connectivity the generator knows, whatever it can carry.
inline std::vector<NamedMesh> allMeshes() {
  return {{"cube", lab::cube()},
          {"quadSphere", lab::quadSphere(3)},
          {"icosphere", lab::icosphere(3)},
          {"bumpyGrid", lab::bumpyGrid(24, 24, 3)},
          {"flatGrid", lab::flatGrid(12, 12)},
          {"polygonMix", lab::polygonMix(5)},
          {"fan", lab::fan(40)},
          {"nonManifold", lab::nonManifold()},
          {"twoComponents", lab::twoComponents(2)},
          {"seamed", lab::seamed(4)},
          {"sculpture", lab::sculpture(1500)},
          {"machinedPart", lab::machinedPart(1500)}};
}

/// Those with room for several copies of 64 bits.
inline std::vector<NamedMesh> roomyMeshes() {
  return {{"quadSphere", lab::quadSphere(4)},
          {"bumpyGrid", lab::bumpyGrid(28, 28, 3)},
          {"polygonMix", lab::polygonMix(5)},
          {"nonManifold", lab::nonManifold()},
          {"twoComponents", lab::twoComponents(2)},
          {"seamed", lab::seamed(4)},
          {"icosphere", lab::icosphere(3)},
          {"sculpture", lab::sculpture(3000)},
          {"machinedPart", lab::machinedPart(3000)}};
}

}  // namespace quadmark::test
