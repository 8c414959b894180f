// SPDX-License-Identifier: MIT
// Watches the sizes of allocations, to show that lying files do not get what they ask for.
#pragma once

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__) || defined(__EMSCRIPTEN__)
#define QM_COUNT_ALLOCATIONS 0  // the sanitizer has its own operator new
#else
#define QM_COUNT_ALLOCATIONS 1
#endif

#if QM_COUNT_ALLOCATIONS
namespace quadmark::test {

/// Forgets what was seen so far.
void resetLargestAllocation();

/// Bytes of the largest single request of operator new since then.
std::size_t largestAllocation();

}  // namespace quadmark::test
#endif
