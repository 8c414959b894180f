// SPDX-License-Identifier: MIT
// The stand-in for builds without Draco's decoder.
#include "io/draco_codec.h"

namespace quadmark::io {

Result<DracoMesh> decodeDraco(Bytes stream, const std::vector<DracoAttribute>&, std::uint64_t memoryLimit,
                              const std::string& place) {
  if (const Result<DracoHeader> header = readDracoHeader(stream, memoryLimit, place); !header) return header.error();
  return unsupportedFile(place + ": this build has no Draco decoder");
}

}  // namespace quadmark::io
