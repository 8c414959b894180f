// SPDX-License-Identifier: MIT
// Loops over vertices, faces or queues on several threads, natively; as wasm they are plain loops.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace quadmark {

namespace detail {

/// Calls part(context, begin, end) for ranges that together are 0..count.
void inParts(std::size_t count, std::size_t least, const void* context,
             void (*part)(const void* context, std::size_t begin, std::size_t end));

}  // namespace detail

/// Below so many items of some hundred instructions each, starting a thread takes longer than what it saves.
inline constexpr std::size_t kLeastPart = 4096;

/// Calls part(begin, end) for ranges of at least `least` items that together are 0..count, side by side where there are
/// cores for it. The outcome must not depend on where ranges end: a part writes only what belongs to its own items, and
/// reads nothing that another one writes.
template <class Part>
void inParts(std::size_t count, std::size_t least, const Part& part) {
#ifdef __EMSCRIPTEN__
  static_cast<void>(least);
  part(std::size_t{0}, count);
#else
  detail::inParts(count, least, &part, [](const void* context, std::size_t begin, std::size_t end) {
    (*static_cast<const Part*>(context))(begin, end);
  });
#endif
}

/// Calls item(i) for all i below `count`, under the same conditions.
template <class Item>
void forEachInParts(std::size_t count, const Item& item) {
  inParts(count, kLeastPart, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) item(i);
  });
}

/// The largest of what part(begin, end) returns for each range, at least 0.
template <class Part>
double largestInParts(std::size_t count, const Part& part) {
  std::vector<double> found(count / kLeastPart + 1, 0.0);  // no two ranges begin within kLeastPart of each other
  inParts(count, kLeastPart, [&](std::size_t begin, std::size_t end) { found[begin / kLeastPart] = part(begin, end); });
  return *std::max_element(found.begin(), found.end());
}

}  // namespace quadmark
