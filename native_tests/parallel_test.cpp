// SPDX-License-Identifier: MIT
// Threads share the work and change nothing.
#include "parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "fixtures.h"
#include "quadmark/metrics.h"
#include "quadmark/robust/embedder.h"
#include "quadmark/threads.h"
#include "robust_geometry_keys.h"

namespace quadmark {
namespace {

// As many threads as a test asks for, until it ends.
class Threads : public testing::Test {
 protected:
  ~Threads() override { useThreads(0); }
};

TEST_F(Threads, DoEachItemOnce) {
  for (const unsigned threads : {1u, 2u, 3u, 7u, 0u})
    for (const std::size_t count :
         {std::size_t{0}, std::size_t{1}, kLeastPart, 2 * kLeastPart - 1, 10 * kLeastPart + 3}) {
      useThreads(threads);
      std::vector<int> done(count, 0);
      forEachInParts(count, [&](std::size_t i) { ++done[i]; });
      EXPECT_EQ(std::count(done.begin(), done.end(), 1), static_cast<std::ptrdiff_t>(count)) << threads;
    }
}

TEST_F(Threads, GetRangesThatAreLongEnough) {
  for (const unsigned threads : {1u, 2u, 3u, 7u}) {
    useThreads(threads);
    std::vector<std::size_t> lengths(100, 0);  // by the range's begin
    inParts(100, 30, [&](std::size_t begin, std::size_t end) { lengths[begin] = end - begin; });
    EXPECT_EQ(std::accumulate(lengths.begin(), lengths.end(), std::size_t{0}), 100u);
    for (const std::size_t length : lengths) EXPECT_TRUE(length == 0 || length >= 30) << length;
  }
}

TEST_F(Threads, FindTheLargestWhereverItIs) {
  const std::size_t count = 5 * kLeastPart + 17;
  for (const std::size_t place : {std::size_t{0}, kLeastPart, 3 * kLeastPart + 1, count - 1}) {
    useThreads(5);
    const auto look = [&](std::size_t begin, std::size_t end) { return begin <= place && place < end ? 7.0 : 1.0; };
    EXPECT_EQ(largestInParts(count, look), 7);
  }
  EXPECT_EQ(largestInParts(0, [](std::size_t, std::size_t) { return 0.0; }), 0);
}

TEST_F(Threads, ChangeNoMarkAndNoMeasure) {
  const Mesh mesh = lab::sculpture(30000);
  robust::CodedPayload payload;
  for (int i = 0; i < 276; ++i) {
    payload.head.push_back(static_cast<std::uint8_t>(i * i % 7 % 2));
    payload.headGenerator.push_back(static_cast<std::uint8_t>(i % 3));
  }
  std::vector<double> positions;
  double distance = 0;
  for (const unsigned threads : {1u, 2u, 5u}) {
    useThreads(threads);
    Mesh marked = mesh;
    marked.positions = robust::embedRobust(mesh, payload, robust::keysOf(1)).value().positions;
    const double hausdorff = distortion(mesh, marked).hausdorffRel;
    if (threads == 1) {
      EXPECT_NE(marked.positions, mesh.positions);
      positions = marked.positions;
      distance = hausdorff;
    }
    EXPECT_EQ(marked.positions, positions) << threads;
    EXPECT_EQ(hausdorff, distance) << threads;
  }
}

}  // namespace
}  // namespace quadmark
