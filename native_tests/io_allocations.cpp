// SPDX-License-Identifier: MIT
// A unit of its own: where the compiler sees both the replaced operators and their callers it warns about the pairing.
#include "io_allocations.h"

#if QM_COUNT_ALLOCATIONS

#include <atomic>
#include <cstdlib>
#include <new>

namespace {
std::atomic<std::size_t> largestRequest{0};
}

void* operator new(std::size_t size) {
  std::size_t seen = largestRequest.load(std::memory_order_relaxed);
  while (size > seen && !largestRequest.compare_exchange_weak(seen, size, std::memory_order_relaxed)) {
  }
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace quadmark::test {

void resetLargestAllocation() {
  largestRequest = 0;
}
std::size_t largestAllocation() {
  return largestRequest;
}

}  // namespace quadmark::test

#endif
