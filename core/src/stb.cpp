// SPDX-License-Identifier: MIT
// The one translation unit that compiles stb: PNG decoding, and the deflate of its PNG writer.
#include "stb.h"

#include <climits>
#include <cstdlib>

namespace {

// A few kilobytes of deflate can ask for gigabytes. 1024 x 1024 pixels of 16-bit RGBA, filtered, take 8.4 MB, and stb
// doubles its buffers: nothing honest comes near this.
constexpr std::size_t kMaxAllocation = 64u << 20;

void* limitedMalloc(std::size_t bytes) {
  return bytes > kMaxAllocation ? nullptr : std::malloc(bytes);
}
void* limitedRealloc(void* block, std::size_t bytes) {
  return bytes > kMaxAllocation ? nullptr : std::realloc(block, bytes);
}

}  // namespace

#define STBI_MALLOC(size) limitedMalloc(size)
#define STBI_REALLOC(block, size) limitedRealloc(block, size)
#define STBI_FREE(block) std::free(block)
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#define STBI_NO_SIMD
#define STBI_NO_LINEAR
#define STBI_NO_HDR
#define STBI_MAX_DIMENSIONS 1024
#define STBI_ASSERT(condition) ((void)0)
#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-but-set-variable"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#include "stb_image.h"
#include "stb_image_write.h"
#pragma GCC diagnostic pop

namespace quadmark::detail {

std::vector<std::uint8_t> decodePngRgba(std::span<const std::uint8_t> png, std::uint32_t& width, std::uint32_t& height,
                                        const char*& failure) {
  int w = 0, h = 0, channels = 0;
  failure = nullptr;
  if (png.size() > INT_MAX) {
    failure = "too large";
    return {};
  }
  stbi_uc* pixels = stbi_load_from_memory(png.data(), static_cast<int>(png.size()), &w, &h, &channels, 4);
  if (!pixels) {
    failure = stbi_failure_reason() ? stbi_failure_reason() : "undecodable";
    return {};
  }
  width = static_cast<std::uint32_t>(w);
  height = static_cast<std::uint32_t>(h);
  std::vector<std::uint8_t> rgba(pixels, pixels + std::size_t{4} * width * height);
  stbi_image_free(pixels);
  return rgba;
}

std::vector<std::uint8_t> zlibCompress(std::vector<std::uint8_t> data) {
  int size = 0;
  unsigned char* packed = stbi_zlib_compress(data.data(), static_cast<int>(data.size()), &size, 8);
  std::vector<std::uint8_t> out(packed, packed + size);
  std::free(packed);
  return out;
}

}  // namespace quadmark::detail
