// SPDX-License-Identifier: MIT
#include "concat.h"
#include "draco_codec.h"
#include "varint_reader.h"

namespace quadmark::io {
namespace {

/// Names and values of a tree of metadata, which nothing here needs. Siblings come before children.
void skipMetadata(VarintReader& reader) {
  std::uint64_t pending = 0;  // subtrees to come, each beginning with its name
  for (bool root = true; (root || pending > 0) && !reader.failed(); root = false) {
    if (!root) {
      --pending;
      reader.skip(reader.byte());
    }
    for (std::uint32_t entries = reader.integer(); entries > 0 && !reader.failed(); --entries) {
      reader.skip(reader.byte());
      reader.skip(reader.integer());
    }
    pending += reader.integer();
  }
}

}  // namespace

Result<DracoHeader> readDracoHeader(Bytes stream, std::uint64_t memoryLimit, const std::string& place) {
  constexpr std::size_t kFixedBytes = 11;  // magic, version, type, method, flags
  if (stream.size() < kFixedBytes || !isDraco(stream)) return badFile(place + ": this is no Draco data");
  const std::string version = concat(stream[5], ".", stream[6]);
  if (version != "2.2") {
    return unsupportedFile(concat(place, ": Draco bitstream version ", version, ", only 2.2 of meshes is supported"));
  }
  if (stream[7] != 1) return unsupportedFile(place + ": the Draco data is a point cloud, it has no triangles");
  DracoHeader header;
  header.isEdgebreaker = stream[8] == 1;
  if (stream[8] > 1) return badFile(concat(place, ": unknown Draco method ", stream[8]));

  // 1. Metadata: first of single attributes, each with its id, then of the whole.
  VarintReader reader(stream.subspan(kFixedBytes));
  header.metadataBegin = kFixedBytes;
  if ((load<std::uint16_t>(&stream[9]) & 0x8000) != 0) {
    for (std::uint32_t count = reader.integer(); count > 0 && !reader.failed(); --count) {
      reader.integer();
      skipMetadata(reader);
    }
    skipMetadata(reader);
  }
  header.metadataEnd = kFixedBytes + reader.at();

  // 2. Counts. The decoder checks how they agree, but not whether they are worth their memory.
  std::uint64_t attributeTables = 0;
  if (header.isEdgebreaker) {
    const std::uint8_t traversal = reader.byte();
    if (!reader.failed() && traversal == 1) {
      return unsupportedFile(place + ": the Draco data is coded by the abandoned predictive edgebreaker");
    }
    reader.integer();  // vertices, at most three per face
    header.faces = reader.integer();
    attributeTables = reader.byte();
  } else {
    header.faces = reader.integer();
  }
  if (reader.failed()) return badFile(place + ": the Draco data ends inside its header");
  constexpr std::uint64_t kTableBytesPerFace = 12, kLimitsForAllTables = 4;
  const std::uint64_t tableBytes = header.faces * kTableBytesPerFace;
  if (tableBytes > memoryLimit || tableBytes * (attributeTables + 1) > kLimitsForAllTables * memoryLimit) {
    return tooLarge(concat(place, ": ", header.faces, " triangles are too many for a file of this size"));
  }
  return header;
}

}  // namespace quadmark::io
