// SPDX-License-Identifier: MIT
// quadmark_speed: how fast and how big embed and extract are natively, from bytes to bytes.
//
//   quadmark_speed IN KEY PNG REPEATS     prints one JSON object:
//   { vertices, fileBytes, embed: {medianMs, minMs, peakBytesPerVertex}, extract: {...} }
//
// Reading files is outside the timer. Peak memory is that of a child process that does the one call, less what the same
// process held before it (program, input file), so it counts everything the call adds, output file included.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include "quadmark/quadmark.h"

namespace {

using namespace quadmark;
using Bytes = std::vector<std::uint8_t>;

Bytes readFile(const char* path) {
  std::ifstream stream(path, std::ios::binary | std::ios::ate);
  Bytes bytes(stream ? static_cast<std::size_t>(stream.tellg()) : 0);
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

long peakKilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

long residentKilobytes() {
  std::ifstream stream("/proc/self/statm");
  long total = 0, resident = 0;
  stream >> total >> resident;
  return resident * (sysconf(_SC_PAGESIZE) / 1024);
}

// Bytes that `call` needs at its peak, measured in a child so that earlier calls leave no trace.
template <class Call>
long peakBytes(const Call& call) {
  int pipes[2];
  if (pipe(pipes) != 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    // The child starts with its parent's pages; only what it adds counts.
    const long before = residentKilobytes();
    call();
    const long added = (peakKilobytes() - before) * 1024;
    const ssize_t written = write(pipes[1], &added, sizeof added);
    _exit(written == sizeof added ? 0 : 1);
  }
  long added = -1;
  if (read(pipes[0], &added, sizeof added) != sizeof added) added = -1;
  close(pipes[0]);
  close(pipes[1]);
  waitpid(child, nullptr, 0);
  return added;
}

template <class Call>
nlohmann::ordered_json measure(int repeats, double vertices, const Call& call) {
  std::vector<double> millis;
  const long peak = peakBytes(call);
  call();  // warm-up
  for (int i = 0; i < repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    call();
    millis.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(millis.begin(), millis.end());
  return {{"medianMs", millis[millis.size() / 2]},
          {"minMs", millis.front()},
          {"peakBytesPerVertex", static_cast<double>(peak) / vertices}};
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s: %s\n", std::string(errorCodeName(error.code)).c_str(), error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: quadmark_speed IN KEY PNG REPEATS\n");
    return 2;
  }
  const Bytes file = readFile(argv[1]), keyText = readFile(argv[2]), png = readFile(argv[3]);
  const int repeats = std::max(1, std::atoi(argv[4]));
  const auto key = parseKey({reinterpret_cast<const char*>(keyText.data()), keyText.size()});
  if (!key) return fail(key.error());
  const auto image = decodePng(png);
  if (!image) return fail(image.error());
  const auto model = readModel(file);
  if (!model) return fail(model.error());
  const auto vertices = static_cast<double>((*model)->mesh().vertexCount());

  EmbedRequest embedRequest;
  embedRequest.key = *key;
  embedRequest.image = *image;
  Bytes marked;
  {
    auto response = embed(file, {}, embedRequest);
    if (!response) return fail(response.error());
    marked = std::move(response->file.bytes);
  }
  ExtractRequest extractRequest;
  extractRequest.key = *key;
  const auto verdict = extract(marked, {}, extractRequest);
  if (!verdict) return fail(verdict.error());
  if (verdict->image.bits != image->bits) return fail({ErrorCode::internal, "the mark was not read back exactly"});

  nlohmann::ordered_json out = {{"vertices", vertices}, {"fileBytes", file.size()}};
  out["embed"] = measure(repeats, vertices, [&] { (void)embed(file, {}, embedRequest); });
  out["extract"] = measure(repeats, vertices, [&] { (void)extract(marked, {}, extractRequest); });
  std::printf("%s\n", out.dump().c_str());
  return 0;
}
