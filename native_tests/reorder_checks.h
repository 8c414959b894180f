// SPDX-License-Identifier: MIT
// What holds for every file whose vertices change their order.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "io_fixtures.h"
#include "quadmark/io/model.h"

namespace quadmark::test {

using Order = std::vector<std::uint32_t>;

inline std::unique_ptr<Model> readOk(const FileBytes& file, const Resources& resources = {}) {
  Result<std::unique_ptr<Model>> model = readModel(file, resources);
  EXPECT_TRUE(model.ok()) << model.error().message;
  return model.ok() ? std::move(model).value() : nullptr;
}

inline OrderFreedom freedomOf(const FileBytes& file, const Resources& resources = {}) {
  const auto model = readOk(file, resources);
  Result<OrderFreedom> freedom = model->orderFreedom(file, resources);
  EXPECT_TRUE(freedom.ok()) << freedom.error().message;
  return freedom.ok() ? std::move(freedom).value() : OrderFreedom{};
}

/// Every range rotated and its neighbours exchanged: no vertex of a range of 4 or more stays.
inline Order mixedOrder(std::size_t vertexCount, const std::vector<VertexRange>& ranges) {
  Order order(vertexCount);
  std::iota(order.begin(), order.end(), 0u);
  for (const VertexRange& range : ranges) {
    const auto begin = order.begin() + range.first, end = begin + range.count;
    std::rotate(begin, begin + range.count / 2, end);
    for (std::uint32_t i = 0; i + 1 < range.count; i += 2) std::swap(begin[i], begin[i + 1]);
  }
  return order;
}

inline Order inverse(const Order& order) {
  Order out(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) out[order[i]] = static_cast<std::uint32_t>(i);
  return out;
}

inline PatchedFile reorderOk(const FileBytes& file, const Order& order, const Resources& resources = {}) {
  const auto model = readOk(file, resources);
  Result<PatchedFile> reordered = model->reorder(file, resources, order);
  EXPECT_TRUE(reordered.ok()) << reordered.error().message;
  return reordered.ok() ? std::move(reordered).value() : PatchedFile{};
}

inline Resources merged(const Resources& resources, const PatchedFile& file) {
  Resources all = file.resources;
  all.insert(resources.begin(), resources.end());
  return all;
}

/// Corner by corner, the positions of all faces.
inline std::vector<double> cornerPositions(const Mesh& mesh) {
  std::vector<double> out;
  for (const std::uint32_t v : mesh.faceVertices) {
    out.insert(out.end(), mesh.positions.begin() + 3 * v, mesh.positions.begin() + 3 * v + 3);
  }
  return out;
}

/// Reorders and checks what holds for every file: same faces, vertices where `order` says, and the way back.
inline PatchedFile checkReorder(const FileBytes& file, const Resources& resources = {}) {
  const auto before = readOk(file, resources);
  const OrderFreedom freedom = freedomOf(file, resources);
  const Order order = mixedOrder(before->mesh().vertexCount(), freedom.ranges);
  PatchedFile out = reorderOk(file, order, resources);
  const Resources all = merged(resources, out);
  const auto after = readOk(out.bytes, all);
  if (after == nullptr) return out;
  EXPECT_EQ(cornerPositions(after->mesh()), cornerPositions(before->mesh()));
  EXPECT_EQ(after->mesh().faceOffsets, before->mesh().faceOffsets);
  EXPECT_EQ(after->mesh().groups, before->mesh().groups);
  for (std::size_t v = 0; v < order.size(); ++v) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(after->mesh().positions[3 * v + axis], before->mesh().positions[3 * order[v] + axis]);
    }
  }
  EXPECT_GT(out.bytesChanged, 0u);
  const PatchedFile back = reorderOk(out.bytes, inverse(order), all);
  EXPECT_EQ(back.bytes, file);
  for (const auto& [uri, bytes] : back.resources) EXPECT_EQ(bytes, resources.at(uri)) << uri;
  EXPECT_EQ(back.bytesChanged, out.bytesChanged);
  Order same(order.size());
  std::iota(same.begin(), same.end(), 0u);
  const PatchedFile unchanged = reorderOk(file, same, resources);
  EXPECT_EQ(unchanged.bytes, file);
  EXPECT_TRUE(unchanged.resources.empty());
  EXPECT_EQ(unchanged.bytesChanged, 0u);
  return out;
}

inline bool mentions(const std::vector<std::string>& warnings, const std::string& what) {
  return std::any_of(warnings.begin(), warnings.end(), [&](const std::string& w) { return w.find(what) != w.npos; });
}

}  // namespace quadmark::test
