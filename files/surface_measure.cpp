#include "files/surface_measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace edgepose {
namespace {

size_t farthest_from(const Eigen::Vector3d& place, std::span<const Eigen::Vector3f> points) {
  size_t best = 0;
  double best_distance = -1;
  for (size_t i = 0; i < points.size(); ++i) {
    const double distance = (points[i].cast<double>() - place).squaredNorm();
    if (distance <= best_distance) continue;
    best_distance = distance;
    best = i;
  }
  return best;
}

size_t farthest_along(const Eigen::Vector3d& direction, std::span<const Eigen::Vector3f> points) {
  const auto less = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
    return a.cast<double>().dot(direction) < b.cast<double>().dot(direction);
  };
  return static_cast<size_t>(std::max_element(points.begin(), points.end(), less) - points.begin());
}

}  // namespace

double estimate_diameter(std::span<const Eigen::Vector3f> points) {
  if (points.size() < 2) return 0;
  constexpr int kStarts[][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 1},
                                {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
  constexpr int kMostSteps = 8;
  double diameter = 0;
  for (const auto& start : kStarts) {
    size_t from = farthest_along(Eigen::Vector3d(start[0], start[1], start[2]), points);
    double reached = 0;
    for (int step = 0; step < kMostSteps; ++step) {
      const Eigen::Vector3d place = points[from].cast<double>();
      const size_t to = farthest_from(place, points);
      const double distance = (points[to].cast<double>() - place).norm();
      if (distance <= reached) break;
      reached = distance;
      from = to;
    }
    diameter = std::max(diameter, reached);
  }
  return diameter;
}

std::vector<Eigen::Vector3f> normals_from_triangles(std::span<const Eigen::Vector3f> vertices,
                                                    std::span<const std::array<uint32_t, 3>> triangles) {
  struct Sum {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), latest = Eigen::Vector3d::Zero();
    double area = 0;
  };
  std::vector<Sum> sums(vertices.size());
  for (const auto& triangle : triangles) {
    const Eigen::Vector3d a = vertices[triangle[0]].cast<double>();
    const Eigen::Vector3d normal =
        (vertices[triangle[1]].cast<double>() - a).cross(vertices[triangle[2]].cast<double>() - a);
    for (const uint32_t vertex : triangle) {
      sums[vertex].sum += normal;
      sums[vertex].latest = normal;
      sums[vertex].area += normal.norm();
    }
  }
  std::vector<Eigen::Vector3f> normals(vertices.size(), Eigen::Vector3f::Zero());
  constexpr double kCancelled = 1e-6;
  for (size_t i = 0; i < sums.size(); ++i) {
    const bool cancelled = sums[i].sum.norm() < kCancelled * sums[i].area;
    const Eigen::Vector3d& normal = cancelled ? sums[i].latest : sums[i].sum;
    const double length = normal.norm();
    if (length > 0 && std::isfinite(length)) normals[i] = (normal / length).cast<float>();
  }
  return normals;
}

}  // namespace edgepose
