// SPDX-License-Identifier: MIT
#include "reorder_order.h"

#include <algorithm>

#include "concat.h"

namespace quadmark::io {

Result<std::vector<std::uint32_t>> invertOrder(std::span<const std::uint32_t> order, std::uint64_t vertexCount,
                                               std::span<const VertexRange> ranges) {
  const auto badOption = [](const std::string& what) { return Error{ErrorCode::badOption, "order: " + what}; };
  if (order.size() != vertexCount) {
    return badOption(concat(order.size(), " entries for ", vertexCount, " vertices"));
  }
  constexpr std::uint32_t kUnset = 0xffffffff;  // never a vertex: their number is below 2^32
  std::vector<std::uint32_t> newOf(order.size(), kUnset);
  std::size_t range = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    while (range < ranges.size() && i >= std::size_t{ranges[range].first} + ranges[range].count) ++range;
    const bool free = range < ranges.size() && i >= ranges[range].first;
    const std::uint64_t first = free ? ranges[range].first : i;
    const std::uint64_t end = free ? first + ranges[range].count : i + 1;
    if (order[i] < first || order[i] >= end) {
      return badOption(concat("entry ", i, " is vertex ", order[i], ", which is outside ", first, "..", end - 1));
    }
    if (newOf[order[i]] != kUnset) return badOption(concat("vertex ", order[i], " appears twice"));
    newOf[order[i]] = static_cast<std::uint32_t>(i);
  }
  return newOf;
}

Status checkReordered(const Mesh& before, std::span<const std::uint32_t> order, std::span<const std::uint32_t> newOf,
                      Bytes file, const Resources& resources) {
  const auto failed = [](const std::string& what) {
    return Error{ErrorCode::internal, "self-check: after reordering, " + what};
  };
  const auto model = readModel(file, resources);
  if (!model) return failed("the file cannot be read: " + model.error().message);
  const Mesh& after = (*model)->mesh();
  if (after.positions.size() != before.positions.size()) return failed("the number of vertices differs");
  for (std::size_t v = 0; v < order.size(); ++v) {
    const auto from = before.positions.begin() + static_cast<std::ptrdiff_t>(3 * std::size_t{order[v]});
    if (std::equal(from, from + 3, after.positions.begin() + static_cast<std::ptrdiff_t>(3 * v))) continue;
    return failed(concat("vertex ", v, " is not where it belongs"));
  }
  const bool sameSizes =
      after.faceOffsets == before.faceOffsets && after.faceVertices.size() == before.faceVertices.size();
  if (!sameSizes) return failed("faces have other sizes");
  for (std::size_t corner = 0; corner < before.faceVertices.size(); ++corner) {
    if (after.faceVertices[corner] == newOf[before.faceVertices[corner]]) continue;
    return failed(concat("corner ", corner, " is another vertex"));
  }
  return okStatus();
}

}  // namespace quadmark::io
