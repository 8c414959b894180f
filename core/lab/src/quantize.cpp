// SPDX-License-Identifier: MIT
#include <algorithm>

#include "mesh_tools.h"

namespace quadmark::lab {

Mesh quantize(const Mesh& mesh, int bits, Grid grid) {
  const Box box = boxOf(weld(mesh).positions);
  const Vec3 size = box.size();
  const double longest = std::max({size.x, size.y, size.z});
  const double low[3] = {box.low.x, box.low.y, box.low.z};
  const double sides[3] = {size.x, size.y, size.z};
  const double levels = static_cast<double>((std::uint64_t{1} << bits) - 1);
  Mesh out = mesh;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double step = (grid == Grid::common ? longest : sides[axis]) / levels;
    if (!(step > 0)) continue;
    for (std::size_t i = axis; i < out.positions.size(); i += 3)
      out.positions[i] = low[axis] + step * std::floor((mesh.positions[i] - low[axis]) / step + 0.5);
  }
  roundToPrecision(out);
  return out;
}

}  // namespace quadmark::lab
