// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

namespace quadmark {

/// Gives a vector's memory back. (`values = {}` assigns an empty list and keeps the memory, as clear() does.)
template <class T>
void release(std::vector<T>& values) {
  std::vector<T>().swap(values);
}

}  // namespace quadmark
