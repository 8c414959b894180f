// SPDX-License-Identifier: MIT
#include "parallel.h"

#include "quadmark/threads.h"

#ifdef __EMSCRIPTEN__

void quadmark::useThreads(unsigned) {}

#else

#include <algorithm>
#include <atomic>
#include <future>
#include <system_error>
#include <thread>
#include <vector>

namespace quadmark {
namespace {

std::atomic<unsigned> most{0};

unsigned threadCount() {
  const unsigned wanted = most;
  return wanted > 0 ? wanted : std::max(1u, std::thread::hardware_concurrency());
}

}  // namespace

void useThreads(unsigned wanted) { most = wanted; }

void detail::inParts(std::size_t count, std::size_t least, const void* context,
                     void (*part)(const void* context, std::size_t begin, std::size_t end)) {
  const std::size_t parts = std::max<std::size_t>(1, std::min<std::size_t>(threadCount(), count / least));
  const auto beginOf = [&](std::size_t i) { return count / parts * i + std::min(i, count % parts); };
  std::vector<std::future<void>> others;
  std::size_t own = parts;  // what no thread could be had for is done here
  for (; own > 1; --own) {
    try {
      others.push_back(std::async(std::launch::async, part, context, beginOf(own - 1), beginOf(own)));
    } catch (const std::system_error&) {
      break;
    }
  }
  part(context, 0, beginOf(own));
  for (std::future<void>& other : others) other.get();
}

}  // namespace quadmark

#endif
