// SPDX-License-Identifier: MIT
// quadmark_speed: how fast and how big embed and extract are natively, from bytes to bytes.
//
//   quadmark_speed IN KEY (PNG | ID) REPEATS     prints one JSON object:
//   { vertices, fileBytes, embed: {medianMs, minMs, oneThreadMs, peakBytesPerVertex}, extract: {...}, search: {...} }
//
// On all cores; oneThreadMs is the median on one.
// ID (hexadecimal, for keys of scheme robust) in place of a picture. "search" reads the unmarked model: every hypothesis
// is tried.
// Reading files is outside the timer. Peak memory is what a process adds while it does the one call, above what it held
// before (program, input file): everything counts, the output file included.
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>
#include "quadmark/quadmark.h"
#include "quadmark/threads.h"
#include "read_file.h"

namespace {

using namespace quadmark;
using bench::readFile;
using Bytes = std::vector<std::uint8_t>;

// A field of /proc/self/status, in bytes.
long statusBytes(const std::string& field) {
  std::ifstream stream("/proc/self/status");
  std::string word;
  long kilobytes = -1;
  while (stream >> word)
    if (word == field + ":") stream >> kilobytes;
  return 1024 * kilobytes;
}

// Bytes that `call` needs at its peak. Measured in a child, on its second call: the first one brings the program's own
// pages in. What is freed is given back at once, so that it neither hides nor adds to what the call takes.
template <class Call>
long peakBytes(const Call& call) {
  int pipes[2];
  if (pipe(pipes) != 0) return -1;
  const pid_t child = fork();
  if (child == 0) {
    mallopt(M_MMAP_THRESHOLD, 1 << 17);
    call();
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << "5\n";  // the peak starts anew
    const long before = statusBytes("VmRSS");
    call();
    const long added = statusBytes("VmHWM") - before;
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
  const long peak = peakBytes(call);
  call();  // warm-up
  const auto times = [&] {
    std::vector<double> millis;
    for (int i = 0; i < repeats; ++i) {
      const auto start = std::chrono::steady_clock::now();
      call();
      millis.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(millis.begin(), millis.end());
    return millis;
  };
  const std::vector<double> millis = times();
  useThreads(1);
  const std::vector<double> alone = times();
  useThreads(0);
  return {{"medianMs", millis[millis.size() / 2]},
          {"minMs", millis.front()},
          {"oneThreadMs", alone[alone.size() / 2]},
          {"peakBytesPerVertex", static_cast<double>(peak) / vertices}};
}

int fail(const Error& error) {
  std::fprintf(stderr, "%s: %s\n", std::string(errorCodeName(error.code)).c_str(), error.message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    std::fprintf(stderr, "usage: quadmark_speed IN KEY (PNG | ID) REPEATS\n");
    return 2;
  }
  const auto input = readFile(argv[1]), keyText = readFile(argv[2]);
  if (!input) return fail(input.error());
  if (!keyText) return fail(keyText.error());
  const Bytes& file = *input;
  const int repeats = std::max(1, std::atoi(argv[4]));
  const auto key = parseKey({reinterpret_cast<const char*>(keyText->data()), keyText->size()});
  if (!key) return fail(key.error());
  const auto model = readModel(file);
  if (!model) return fail(model.error());
  const auto vertices = static_cast<double>((*model)->mesh().vertexCount());

  EmbedRequest embedRequest;
  embedRequest.key = *key;
  if (key->scheme == "robust") {
    embedRequest.id = std::strtoull(argv[3], nullptr, 16);
  } else {
    const auto png = readFile(argv[3]);
    if (!png) return fail(png.error());
    auto image = decodePng(*png);
    if (!image) return fail(image.error());
    embedRequest.image = std::move(*image);
  }
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
  if (verdict->id != embedRequest.id || (embedRequest.image && verdict->image.bits != embedRequest.image->bits))
    return fail({ErrorCode::internal, "the mark was not read back exactly"});

  nlohmann::ordered_json out = {{"vertices", vertices}, {"fileBytes", file.size()}};
  out["embed"] = measure(repeats, vertices, [&] { (void)embed(file, {}, embedRequest); });
  out["extract"] = measure(repeats, vertices, [&] { (void)extract(marked, {}, extractRequest); });
  out["search"] = measure(repeats, vertices, [&] { (void)extract(file, {}, extractRequest); });
  std::printf("%s\n", out.dump().c_str());
  return 0;
}
