// SPDX-License-Identifier: MIT
// One fuzz target, which exercises its input by the function QM_FUZZ_EXERCISE of exercise.h. Besides what the
// sanitizers look for, a run fails when it holds more memory at a time than inputs of its size may ask for.
#include <sanitizer/allocator_interface.h>

#include <cstdio>
#include <cstdlib>

#include "fuzz/exercise.h"

namespace {

bool watching = false;
long long held = 0, mostHeld = 0;

void onAllocation(const volatile void*, std::size_t bytes) {
  if (!watching) return;
  held += static_cast<long long>(bytes);
  if (held > mostHeld) mostHeld = held;
}

void onRelease(const volatile void* memory) {
  if (watching && memory != nullptr) {
    held -= static_cast<long long>(__sanitizer_get_allocated_size(const_cast<const void*>(memory)));
  }
}

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "quadmark: %s\n", what);
  std::abort();  // libFuzzer keeps the input
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  if (__sanitizer_install_malloc_and_free_hooks(onAllocation, onRelease) == 0) fail("no hooks for allocations");
  static_cast<void>(quadmark::test::QM_FUZZ_EXERCISE({}));  // what is made once is no input's doing
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  held = mostHeld = 0;
  watching = true;
  const quadmark::test::Problem problem = quadmark::test::QM_FUZZ_EXERCISE({data, size});
  watching = false;
  if (!problem.empty()) fail(problem.c_str());
  if (mostHeld > 8 * static_cast<long long>(size) + (64 << 20)) fail("more memory than 8 times the input and 64 MB");
  return 0;
}
