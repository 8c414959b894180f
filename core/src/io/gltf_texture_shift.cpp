// SPDX-License-Identifier: MIT
#include "gltf_texture_shift.h"

#include <array>
#include <cmath>

#include "data_uri.h"
#include "image_size.h"
#include "number_text.h"
#include "point_triangle.h"

namespace quadmark::io {
namespace {

using detail::dot;
using detail::Point;

using Pair = std::array<double, 2>;

// Width and height in pixels; zeros where they are not known.
Pair texelsOf(JsonValue image, const GltfDocument& document, const Resources& resources,
              const std::vector<BufferBytes>& buffers) {
  Bytes bytes;
  std::vector<std::uint8_t> decoded;
  const JsonValue uri = image.find("uri");
  const std::string_view spelled = uri.isString() ? uri.text().substr(1, uri.text().size() - 2) : std::string_view();
  if (const auto index = image.find("bufferView").asUnsigned(); index && *index < document.views.size()) {
    const GltfView& view = document.views[static_cast<std::size_t>(*index)];
    if (view.buffer != kNone && view.compression.empty() &&
        view.byteOffset + view.byteLength <= buffers[view.buffer].bytes.size()) {
      bytes = buffers[view.buffer].bytes.subspan(static_cast<std::size_t>(view.byteOffset),
                                                 static_cast<std::size_t>(view.byteLength));
    }
  } else if (isDataUri(spelled)) {
    if (Result<std::vector<std::uint8_t>> result = decodeDataUri(spelled, "image")) decoded = std::move(*result);
    bytes = decoded;
  } else if (const auto found = resources.find(std::string(spelled)); found != resources.end()) {
    bytes = found->second;
  }
  const auto size = imageSize(bytes).value_or(std::array<std::uint32_t, 2>{0, 0});
  return {static_cast<double>(size[0]), static_cast<double>(size[1])};
}

// The texture coordinates of an accessor's elements.
class Coordinates {
 public:
  Coordinates(const GltfDocument& document, std::uint32_t index, const std::vector<BufferBytes>& buffers)
      : accessor_(document.accessors[index]) {
    const GltfView& view = document.views[accessor_.view];
    bytes_ = buffers[view.buffer].bytes.data() + view.byteOffset + accessor_.byteOffset;
    stride_ = view.byteStride == 0 ? accessor_.elementBytes() : view.byteStride;
    const auto grid = PositionType{accessor_.componentType, accessor_.normalized}.grid();
    if (grid) divisor_ = grid->divisor;
  }
  [[nodiscard]] double operator()(std::uint32_t element, std::size_t axis) const {
    const std::uint8_t* code = bytes_ + std::size_t{element} * stride_ + axis * componentBytes(accessor_.componentType);
    return withComponent(accessor_.componentType,
                         [&](auto component) { return decodeComponent(load<decltype(component)>(code), divisor_); });
  }

 private:
  const GltfAccessor& accessor_;
  const std::uint8_t* bytes_;
  std::size_t stride_;
  double divisor_ = 1;
};

// Calls visit(object) for all members of a material that show a texture. Whatever its name is, one with an index does:
// extensions bring their own.
template <class Visit>
void forEachTexture(JsonValue material, const Visit& visit) {
  const auto visitMembers = [&](JsonValue object) {
    object.forEachMember([&](std::string_view, JsonValue member) {
      if (member.find("index")) visit(member);
    });
  };
  visitMembers(material);
  visitMembers(material.find("pbrMetallicRoughness"));
  material.find("extensions").forEachMember([&](std::string_view, JsonValue extension) { visitMembers(extension); });
}

// The image of a texture; WebP, Basis and AVIF are named by extensions.
std::optional<std::uint64_t> imageOf(JsonValue texture) {
  std::optional<std::uint64_t> image = texture.find("source").asUnsigned();
  texture.find("extensions").forEachMember([&](std::string_view, JsonValue extension) {
    if (const auto own = extension.find("source").asUnsigned()) image = own;
  });
  return image;
}

// A vertex's displacement in texture coordinates: the mean of what the maps of its triangles make of it, weighted by
// area.
struct VertexShift {
  double sum[2] = {0, 0};
  double area = 0;
};

void addTriangle(const std::uint32_t* corners, std::uint32_t firstVertex, const Coordinates& coordinates,
                 const std::vector<double>& before, const std::vector<double>& after,
                 std::vector<VertexShift>& shifts) {
  using detail::pointAt;
  const Point origin = pointAt(before, corners[0]);
  const Point e1 = pointAt(before, corners[1]) - origin, e2 = pointAt(before, corners[2]) - origin;
  const double g11 = dot(e1, e1), g12 = dot(e1, e2), g22 = dot(e2, e2), determinant = g11 * g22 - g12 * g12;
  if (!(determinant > 1e-20 * g11 * g22)) return;  // no plane
  const double area = std::sqrt(determinant);
  for (int corner = 0; corner < 3; ++corner) {
    const Point moved = pointAt(after, corners[corner]) - pointAt(before, corners[corner]);
    const double b1 = dot(e1, moved), b2 = dot(e2, moved);
    const double along1 = (g22 * b1 - g12 * b2) / area, along2 = (g11 * b2 - g12 * b1) / area;
    VertexShift& shift = shifts[corners[corner]];
    shift.area += area;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double at = coordinates(corners[0] - firstVertex, axis);
      shift.sum[axis] += along1 * (coordinates(corners[1] - firstVertex, axis) - at) +
                         along2 * (coordinates(corners[2] - firstVertex, axis) - at);
    }
  }
}

}  // namespace

void TextureShiftMeter::take(const GltfPrimitive& primitive, double distance, bool inTexels) {
  if (!(distance >= 0)) return;  // coordinates that are no numbers
  if (!shift_) shift_.emplace();
  if (inTexels && !shift_->texels) shift_->texels = -1;
  double& largest = inTexels ? *shift_->texels : shift_->uv;
  if (!(distance > largest)) return;
  largest = distance;
  if (inTexels || !shift_->texels) shift_->place = primitive.place();
}

void TextureShiftMeter::measure(const GltfDocument& document, const Resources& resources,
                                const std::vector<BufferBytes>& buffers, const PositionArrays& positions,
                                const Mesh& after, const std::vector<PrimitiveFaces>& faces) {
  if (before_.size() != after.positions.size()) return;
  std::vector<Pair> texels(document.images.size(), Pair{-1, -1});  // below 0: not looked at yet
  std::vector<VertexShift> shifts(after.vertexCount());
  // Materials may have any number of textures; sane files stay far below this.
  std::uint64_t budget = 64 * std::uint64_t{after.faceVertices.size()};
  for (const PrimitiveFaces& part : faces) {
    const GltfPrimitive& primitive = *part.primitive;
    const PositionWindow& window = positions.windows[positions.windowOf[primitive.position]];
    if (primitive.material >= document.materials.size() || !window.isStored() || window.values != kNone) continue;
    forEachTexture(document.materials[primitive.material], [&](JsonValue shown) {
      const JsonValue transform = shown.find("extensions").find("KHR_texture_transform");
      const std::uint64_t index = shown.find("index").asUnsigned().value_or(kNone);
      std::uint64_t set = shown.find("texCoord").asUnsigned().value_or(0);
      set = transform.find("texCoord").asUnsigned().value_or(set);
      if (index >= document.textures.size() || set >= primitive.textureCoordinates.size()) return;
      const std::uint32_t accessor = primitive.textureCoordinates[static_cast<std::size_t>(set)];
      if (accessor == kNone || document.accessors[accessor].count < window.count || budget < part.end - part.begin)
        return;
      budget -= part.end - part.begin;

      Pair scale{1, 1}, pixels{0, 0};
      std::size_t axis = 0;
      transform.find("scale").forEachElement([&](JsonValue value) {
        if (axis < 2) scale[axis++] = parseDouble(value.text()).value_or(1);
      });
      const auto image = imageOf(document.textures[static_cast<std::size_t>(index)]);
      if (image && *image < texels.size()) {
        Pair& size = texels[static_cast<std::size_t>(*image)];
        if (size[0] < 0)
          size = texelsOf(document.images[static_cast<std::size_t>(*image)], document, resources, buffers);
        pixels = size;
      }
      const Coordinates coordinates(document, accessor, buffers);
      const std::uint32_t* corners = after.faceVertices.data();
      for (std::size_t c = part.begin; c < part.end; c += 3)
        addTriangle(corners + c, static_cast<std::uint32_t>(window.firstVertex), coordinates, before_, after.positions,
                    shifts);
      for (std::size_t c = part.begin; c < part.end; ++c) {
        VertexShift& shift = shifts[corners[c]];
        if (shift.area > 0) {
          const double u = shift.sum[0] / shift.area * scale[0], v = shift.sum[1] / shift.area * scale[1];
          take(primitive, std::sqrt(u * u + v * v), false);
          if (pixels[0] > 0)
            take(primitive, std::sqrt(u * u * pixels[0] * pixels[0] + v * v * pixels[1] * pixels[1]), true);
        }
        shift = {};
      }
    });
  }
}

}  // namespace quadmark::io
