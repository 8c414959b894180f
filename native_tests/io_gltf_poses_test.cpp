// SPDX-License-Identifier: MIT
// Skinned, morphed and instanced models crack nowhere: vertices that coincide in a pose still do after marking.
#include <array>
#include <cmath>
#include <map>
#include <tuple>

#include "fixtures.h"
#include "io/gltf_buffers.h"
#include "io/gltf_components.h"
#include "io_fixtures.h"
#include "json_text.h"
#include "models.h"

namespace quadmark::test {
namespace {

using Vector = std::array<double, 3>;

/// The attributes of a file's primitives, read from its JSON as the specification has it.
class PosedFile {
 public:
  PosedFile(const FileBytes& file, const Resources& resources) : file_(file) {
    container_ = *io::openGltf(file_);
    root_ = *parseJson(container_.json(file_));
    std::size_t index = 0;
    root_.find("buffers").forEachElement([&](JsonValue buffer) {
      const std::string uri = buffer.find("uri").asString();
      const io::Bytes bin = container_.hasBin && index == 0 && uri.empty() ? container_.bin(file_) : io::Bytes(resources.at(uri));
      buffers_.emplace_back(bin.begin(), bin.end());
      ++index;
    });
  }

  [[nodiscard]] JsonValue item(const char* list, std::uint64_t index) const {
    JsonValue found;
    std::uint64_t i = 0;
    root_.find(list).forEachElement([&](JsonValue value) {
      if (i++ == index) found = value;
    });
    return found;
  }

  /// All components of an accessor.
  [[nodiscard]] std::vector<double> values(JsonValue reference, std::size_t components) const {
    const JsonValue accessor = item("accessors", *reference.asUnsigned());
    const auto number = [](JsonValue object, const char* name) { return object.find(name).asUnsigned().value_or(0); };
    const JsonValue view = item("bufferViews", number(accessor, "bufferView"));
    const auto type = static_cast<std::uint32_t>(number(accessor, "componentType"));
    const std::size_t width = io::componentBytes(type);
    const std::size_t stride = number(view, "byteStride") == 0 ? components * width : number(view, "byteStride");
    const std::uint8_t* element =
        buffers_[number(view, "buffer")].data() + number(view, "byteOffset") + number(accessor, "byteOffset");
    std::vector<double> out;
    for (std::uint64_t i = 0; i < number(accessor, "count"); ++i, element += stride)
      for (std::size_t k = 0; k < components; ++k)
        out.push_back(io::withComponent(type, [&](auto component) -> double {
          return io::load<decltype(component)>(element + k * width);
        }));
    return out;
  }

  /// Calls visit(mesh, rest, posed) for every vertex of every primitive. Any pose will do to see a crack: morph targets
  /// at arbitrary weights, joints under arbitrary affine maps.
  template <class Visit>
  void forEachVertex(const Visit& visit) const {
    std::uint32_t mesh = 0;
    root_.find("meshes").forEachElement([&](JsonValue json) {
      json.find("primitives").forEachElement([&](JsonValue primitive) {
        const JsonValue attributes = primitive.find("attributes");
        const std::vector<double> rest = values(attributes.find("POSITION"), 3);
        std::vector<double> morphed = rest;
        double weight = 0.37;
        primitive.find("targets").forEachElement([&](JsonValue target) {
          const std::vector<double> delta = values(target.find("POSITION"), 3);
          for (std::size_t i = 0; i < morphed.size(); ++i) morphed[i] += weight * delta[i];
          weight += 0.21;
        });
        std::vector<double> joints, weights;
        if (attributes.find("JOINTS_0")) {
          joints = values(attributes.find("JOINTS_0"), 4);
          weights = values(attributes.find("WEIGHTS_0"), 4);
        }
        for (std::size_t v = 0; 3 * v < rest.size(); ++v) {
          const Vector p = {morphed[3 * v], morphed[3 * v + 1], morphed[3 * v + 2]};
          Vector posed = p;
          if (!joints.empty()) {
            posed = {0, 0, 0};
            for (std::size_t k = 0; k < 4; ++k)
              for (std::size_t axis = 0; axis < 3; ++axis) posed[axis] += weights[4 * v + k] * jointed(joints[4 * v + k], p, axis);
          }
          visit(mesh, Vector{rest[3 * v], rest[3 * v + 1], rest[3 * v + 2]}, posed);
        }
      });
      ++mesh;
    });
  }

 private:
  static double jointed(double joint, const Vector& p, std::size_t axis) {
    const double a = 0.1 + 0.07 * joint + 0.3 * static_cast<double>(axis);
    return a * p[0] + (1 - a) * p[1] + (0.5 + a * a) * p[2] + joint;
  }

  const FileBytes& file_;
  io::GltfContainer container_;
  JsonValue root_;
  std::vector<FileBytes> buffers_;
};

TEST(Poses, ShowNoCrackAfterMarking) {
  int present = 0, written = 0, twins = 0;
  for (const char* name : {"CesiumMan.glb", "riggedMesh.glb", "AnimatedMorphCube/AnimatedMorphCube.gltf", "morphLoader.glb",
                           "CubeScaledInstances/cube_att.gltf", "Fox/Fox.gltf"}) {
    SCOPED_TRACE(name);
    const std::optional<FileBytes> file = modelBytes(name);
    if (!file) continue;
    ++present;
    const Resources resources = modelResources(name, *externalUris(*file));
    EmbedRequest request;
    request.key = idKey();
    request.id = 0x0123456789abcdef;
    auto marked = embed(*file, resources, request);
    PatchedFile out;
    if (marked.ok()) {
      out = std::move(marked->file);
      ++written;
    } else {  // too small for a mark: another movement that keeps twins together
      ASSERT_EQ(marked.error().code, ErrorCode::capacity) << marked.error().message;
      const auto model = readModel(*file, resources);
      ASSERT_TRUE(model.ok());
      const WeldedMesh welded = weld((*model)->mesh());
      Mesh moved = (*model)->mesh();
      for (std::size_t v = 0; v < moved.vertexCount(); ++v)
        if (welded.weldedOf[v] != kNoVertex)
          for (std::size_t axis = 0; axis < 3; ++axis) moved.positions[3 * v + axis] *= 1 + 1e-3 * (welded.weldedOf[v] % 7);
      roundToPrecision(moved);
      out = std::move((*model)->patch(*file, resources, moved.positions).value());
    }
    Resources changed = resources;
    for (const auto& [uri, bytes] : out.resources) changed[uri] = bytes;

    struct Place {
      std::uint32_t mesh;
      Vector rest, posed;
      bool operator<(const Place& other) const {
        return std::tie(mesh, rest, posed) < std::tie(other.mesh, other.rest, other.posed);
      }
    };
    std::vector<Place> before, after;
    PosedFile(*file, resources).forEachVertex(
        [&](std::uint32_t mesh, const Vector& rest, const Vector& posed) { before.push_back({mesh, rest, posed}); });
    PosedFile(out.bytes, changed).forEachVertex(
        [&](std::uint32_t mesh, const Vector& rest, const Vector& posed) { after.push_back({mesh, rest, posed}); });
    ASSERT_EQ(before.size(), after.size());
    std::map<Place, std::size_t> first;
    bool anyMoved = false;
    for (std::size_t v = 0; v < before.size(); ++v) {
      anyMoved = anyMoved || before[v].rest != after[v].rest;
      const auto [twin, isNew] = first.emplace(before[v], v);
      if (isNew) continue;
      ++twins;
      EXPECT_EQ(after[v].rest, after[twin->second].rest) << "vertex " << v;
      EXPECT_EQ(after[v].posed, after[twin->second].posed) << "vertex " << v;
    }
    EXPECT_TRUE(anyMoved);
  }
  if (present == 6) {
    EXPECT_GE(written, 3);
    EXPECT_GT(twins, 1000);
  }
}

}  // namespace
}  // namespace quadmark::test
