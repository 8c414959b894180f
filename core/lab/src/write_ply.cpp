// SPDX-License-Identifier: MIT
#include <algorithm>

#include "byte_writer.h"
#include "quadmark/lab/attacks.h"

namespace quadmark::lab {

std::vector<std::uint8_t> writePly(const Mesh& mesh) {
  std::size_t longest = 0;
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) longest = std::max(longest, mesh.faceEnd(f) - mesh.faceBegin(f));
  const bool wideCounts = longest > 255, wide = mesh.precision == Precision::float64;
  const std::string coordinate = wide ? "property double " : "property float ";
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                             std::to_string(mesh.vertexCount()) + "\n" + coordinate + "x\n" + coordinate + "y\n" +
                             coordinate + "z\nelement face " + std::to_string(mesh.faceCount()) + "\nproperty list " +
                             (wideCounts ? "uint" : "uchar") + " int vertex_indices\nend_header\n";
  ByteWriter out(header.size() + mesh.positions.size() * (wide ? 8 : 4) + mesh.faceVertices.size() * 4 +
                 mesh.faceCount() * (wideCounts ? 4 : 1));
  out.text(header);
  for (double x : mesh.positions)
    if (wide)
      out.float64(x);
    else
      out.float32(static_cast<float>(x));
  for (std::size_t f = 0; f < mesh.faceCount(); ++f) {
    const auto corners = static_cast<std::uint32_t>(mesh.faceEnd(f) - mesh.faceBegin(f));
    if (wideCounts)
      out.uint32(corners);
    else
      out.byte(static_cast<std::uint8_t>(corners));
    for (std::size_t c = mesh.faceBegin(f); c < mesh.faceEnd(f); ++c) out.uint32(mesh.faceVertices[c]);
  }
  return out.take();
}

}  // namespace quadmark::lab
