// SPDX-License-Identifier: MIT
// Mutates a GLB inside its chunks and makes the lengths in its headers true again; else hardly any mutant would get
// past them. Every other time, and for anything but a sound GLB, the bytes are mutated as they are.
#include <algorithm>
#include <cstring>

#include "io/gltf_container.h"
#include "io_fixtures.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t capacity);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t capacity,
                                               unsigned int seed) {
  using namespace quadmark;
  const io::Bytes file(data, size);
  const Result<io::GltfContainer> container = io::openGltf(file);
  if (seed % 2 == 0 || !container.ok() || !container->isGlb) return LLVMFuzzerMutate(data, size, capacity);

  std::string json(container->json(file));
  test::FileBytes bin;
  if (container->hasBin) bin.assign(data + container->binBegin, data + container->binEnd);
  const auto mutate = [&](auto& chunk) {
    const std::size_t before = chunk.size();
    chunk.resize(before + 64);
    chunk.resize(LLVMFuzzerMutate(reinterpret_cast<std::uint8_t*>(chunk.data()), before, chunk.size()));
  };
  if (seed % 8 == 1 && !bin.empty()) {
    mutate(bin);
  } else {
    mutate(json);
  }
  const test::FileBytes mutant = test::makeGlb(json, bin);
  if (mutant.size() > capacity) return LLVMFuzzerMutate(data, size, capacity);
  std::copy(mutant.begin(), mutant.end(), data);
  return mutant.size();
}
