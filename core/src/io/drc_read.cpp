// SPDX-License-Identifier: MIT
#include "quadmark/io/drc.h"

#include <cmath>

#include "concat.h"
#include "draco_codec.h"
#include "gltf_buffers.h"

namespace quadmark {
namespace io {
namespace {

class DrcModel final : public Model {
 public:
  Status read(Bytes file) {
    const std::uint64_t limit = memoryLimit(file, {});
    Result<DracoMesh> decoded = decodeDraco(file, {DracoAttribute{}}, limit, "Draco");
    if (!decoded) return decoded.error();
    info_.format = FileFormat::drc;
    info_.variant = concat("Draco ", file[5], ".", file[6]);
    info_.meshes = info_.primitives = 1;
    if (decoded->pointCount > limit / (3 * sizeof(double))) return tooLarge("Draco: too many points for this file");
    mesh_.faceVertices = std::move(decoded->indices);
    mesh_.positions.resize(static_cast<std::size_t>(3 * decoded->pointCount));
    const std::vector<std::uint8_t>& values = decoded->values[0];
    for (std::size_t i = 0; i < mesh_.positions.size(); ++i) {
      mesh_.positions[i] = load<float>(&values[sizeof(float) * i]);
      if (std::isfinite(mesh_.positions[i])) continue;
      return badMesh(concat("Draco: point ", i / 3, ", component ", "xyz"[i % 3], " is not finite"));
    }
    if (mesh_.faceCount() == 0) return badMesh("Draco: the file has no triangles");
    return boundingDiagonal(mesh_) > 0 ? okStatus() : Status(badMesh("Draco: all used points coincide"));
  }

  [[nodiscard]] Status checkMarkable() const override {
    return unsupportedFile(
        "a .drc cannot be marked: Draco rounds what it stores; mark the PLY, glTF or GLB that it is made from");
  }
  [[nodiscard]] Result<PatchedFile> patch(std::span<const std::uint8_t>, const Resources&,
                                          std::span<const double>) const override {
    return checkMarkable().error();
  }
  [[nodiscard]] Result<OrderFreedom> orderFreedom(std::span<const std::uint8_t>, const Resources&) const override {
    return OrderFreedom{{}, {"the order of the vertices of a .drc is fixed"}};
  }
  [[nodiscard]] Result<PatchedFile> reorder(std::span<const std::uint8_t>, const Resources&,
                                            std::span<const std::uint32_t>) const override {
    return checkMarkable().error();
  }
};

}  // namespace
}  // namespace io

bool isDrc(std::span<const std::uint8_t> file) { return io::isDraco(file); }

Result<std::unique_ptr<Model>> readDrc(std::span<const std::uint8_t> file) {
  auto model = std::make_unique<io::DrcModel>();
  if (Status status = model->read(file); !status) return status.error();
  return std::unique_ptr<Model>(std::move(model));
}

}  // namespace quadmark
