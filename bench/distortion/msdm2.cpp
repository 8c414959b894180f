// SPDX-License-Identifier: MIT
#include "msdm2.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "curvature.h"
#include "triangle_tree.h"

namespace quadmark::bench {
namespace {

using detail::Point;

constexpr double kCurvatureRadii[] = {0.002, 0.003, 0.004};  // of the longest side
constexpr double kWindow = 5;                                // window radius / curvature radius
constexpr double kStabilizer = 1;
constexpr double kLuminance = 0.4, kContrast = 0.4, kStructure = 0.2;
constexpr double kPooling = 3;

struct Surface {
  explicit Surface(const Mesh& from) : mesh(from), welded(weld(from)), graph(surfaceGraph(from, welded)), tree(from) {}

  const Mesh& mesh;
  const WeldedMesh welded;
  const SurfaceGraph graph;
  const detail::TriangleTree tree;
};

double longestSide(const SurfaceGraph& graph) {
  Point low = graph.points.front(), high = low;
  for (const Point& p : graph.points) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  return std::max({high.x - low.x, high.y - low.y, high.z - low.z});
}

/// A place on a surface: corners (welded) and their barycentric shares.
struct Place {
  Point point;
  std::array<std::uint32_t, 3> corners;
  std::array<double, 3> shares;
};

/// The place of a triangle that is nearest to p.
Place nearestPlace(const Point& p, const std::array<Point, 3>& t, const std::array<std::uint32_t, 3>& corners) {
  std::array<double, 3> best{1, 0, 0};
  const Point ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], normal = cross(ab, ac);
  const double area = squared(normal), v = dot(cross(ap, ac), normal), w = dot(cross(ab, ap), normal);
  if (area > 0 && v >= 0 && w >= 0 && v + w <= area) {
    best = {1 - (v + w) / area, v / area, w / area};
  } else {
    double least = squared(ap);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Point edge = t[j] - t[i];
      const double length = squared(edge);
      const double along = length > 0 ? std::clamp(dot(p - t[i], edge) / length, 0.0, 1.0) : 0;
      const double distance = squared(p - t[i] - along * edge);
      if (distance >= least) continue;
      least = distance;
      best = {0, 0, 0};
      best[i] = 1 - along;
      best[j] = along;
    }
  }
  return {best[0] * t[0] + best[1] * t[1] + best[2] * t[2], corners, best};
}

std::vector<Place> project(const Surface& from, const Surface& onto) {
  std::vector<Place> places;
  places.reserve(from.graph.points.size());
  std::uint32_t hint = 0;
  for (const Point& p : from.graph.points) {
    (void)onto.tree.nearest(p, -1, hint);
    std::array<Point, 3> triangle;
    std::array<std::uint32_t, 3> corners = onto.tree.corners(hint);
    for (std::size_t i = 0; i < 3; ++i) {
      triangle[i] = detail::pointAt(onto.mesh.positions, corners[i]);
      corners[i] = onto.welded.weldedOf[corners[i]];
    }
    places.push_back(nearestPlace(p, triangle, corners));
  }
  return places;
}

/// Curvatures of a window and of its image on the other surface, with the weights of either.
class Window {
 public:
  explicit Window(double radius) : scale_(2 / (radius * radius)) {}  // 1 / (2 s^2), s = radius / 2

  void clear() { samples_.clear(); }
  /// @param away, awayThere  squared distances from the window's centre and from that one's image.
  void add(double away, double curvature, double awayThere, double curvatureThere) {
    samples_.push_back({std::exp(-away * scale_), curvature, std::exp(-awayThere * scale_), curvatureThere});
  }

  /// The local distortion of this scale.
  [[nodiscard]] double distortion() const {
    double all = 0, allThere = 0, mean = 0, meanThere = 0;
    for (const Sample& s : samples_) {
      all += s.weight, allThere += s.weightThere;
      mean += s.weight * s.curvature, meanThere += s.weightThere * s.curvatureThere;
    }
    mean /= all, meanThere /= allThere;
    double variance = 0, varianceThere = 0, covariance = 0;
    for (const Sample& s : samples_) {
      const double off = s.curvature - mean, offThere = s.curvatureThere - meanThere;
      variance += s.weight * off * off, varianceThere += s.weightThere * offThere * offThere;
      covariance += s.weight * off * offThere;
    }
    const double deviation = std::sqrt(variance / all), deviationThere = std::sqrt(varianceThere / allThere);
    const double product = deviation * deviationThere;
    return kLuminance * std::abs(mean - meanThere) / (std::max(mean, meanThere) + kStabilizer) +
           kContrast * std::abs(deviation - deviationThere) / (std::max(deviation, deviationThere) + kStabilizer) +
           kStructure * std::abs(product - covariance / all) / (product + kStabilizer);
  }

 private:
  struct Sample {
    double weight, curvature, weightThere, curvatureThere;
  };
  double scale_;
  std::vector<Sample> samples_;
};

/// Adds the local distortions of one scale at each vertex. Where an edge leaves the window, the place where it does
/// counts as a sample, so that windows are full on coarse meshes, too.
void addScale(const SurfaceGraph& graph, const std::vector<Place>& images, const std::vector<double>& curvature,
              const std::vector<double>& curvatureThere, double radius, std::vector<double>& local) {
  std::vector<double> imageCurvature(images.size(), 0);
  for (std::size_t v = 0; v < images.size(); ++v)
    for (std::size_t i = 0; i < 3; ++i) imageCurvature[v] += images[v].shares[i] * curvatureThere[images[v].corners[i]];
  BallWalk ball(graph);
  Window window(radius);
  for (std::uint32_t centre = 0; centre < local.size(); ++centre) {
    const Point here = graph.points[centre], there = images[centre].point;
    window.clear();
    ball.run(
        centre, radius,
        [&](std::uint32_t v) {
          window.add(squared(graph.points[v] - here), curvature[v], squared(images[v].point - there),
                     imageCurvature[v]);
        },
        [&](std::uint32_t from, const SurfaceGraph::Edge& edge, double share) {
          if (share == 1) return;
          const auto between = [&](const auto& a, const auto& b) { return (1 - share) * a + share * b; };
          window.add(squared(between(graph.points[from], graph.points[edge.to]) - here),
                     between(curvature[from], curvature[edge.to]),
                     squared(between(images[from].point, images[edge.to].point) - there),
                     between(imageCurvature[from], imageCurvature[edge.to]));
        });
    local[centre] += window.distortion();
  }
}

double pooled(const std::vector<double>& local) {
  double sum = 0;
  for (const double value : local) sum += std::pow(value / std::size(kCurvatureRadii), kPooling);
  return std::pow(sum / static_cast<double>(local.size()), 1 / kPooling);
}

}  // namespace

double msdm2(const Mesh& a, const Mesh& b) {
  const Surface first(a), second(b);
  const double size = std::max(longestSide(first.graph), longestSide(second.graph));
  if (!(size > 0)) return 0;
  const std::vector<Place> onSecond = project(first, second), onFirst = project(second, first);
  std::vector<double> localFirst(onSecond.size(), 0), localSecond(onFirst.size(), 0);
  for (const double share : kCurvatureRadii) {
    std::vector<double> curvatureFirst = meanCurvature(first.graph, share * size);
    std::vector<double> curvatureSecond = meanCurvature(second.graph, share * size);
    for (std::vector<double>* curvature : {&curvatureFirst, &curvatureSecond})
      for (double& k : *curvature) k *= size;
    addScale(first.graph, onSecond, curvatureFirst, curvatureSecond, kWindow * share * size, localFirst);
    addScale(second.graph, onFirst, curvatureSecond, curvatureFirst, kWindow * share * size, localSecond);
  }
  return (pooled(localFirst) + pooled(localSecond)) / 2;
}

}  // namespace quadmark::bench
