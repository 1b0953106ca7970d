#include "matcher/surface_sampling.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>

#include "matcher/parallel.h"
#include "matcher/point_grid.h"
#include "matcher/view_sphere.h"

namespace edgepose {
namespace {

/// Uniform in [0, 1) and the same on every platform, unlike std::uniform_real_distribution.
double unit_random(std::mt19937_64& generator) { return static_cast<double>(generator() >> 11) * 0x1.0p-53; }

template <typename T>
void shuffle(std::vector<T>& values, std::mt19937_64& generator) {
  for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[generator() % i]);
}

std::vector<OrientedPoint> sample_cloud(const Mesh& cloud, size_t count, std::mt19937_64& generator) {
  if (cloud.vertices.size() < 100)
    throw std::invalid_argument("expected at least 100 points in a model cloud, found " +
                                std::to_string(cloud.vertices.size()));
  if (cloud.normals.size() != cloud.vertices.size())
    throw std::invalid_argument("expected a normal for every point of a model cloud, found " +
                                std::to_string(cloud.normals.size()) + " for " +
                                std::to_string(cloud.vertices.size()) + " points");
  std::vector<OrientedPoint> points;
  for (size_t i = 0; i < cloud.vertices.size(); ++i) {
    const float length = cloud.normals[i].norm();
    if (cloud.vertices[i].allFinite() && length > 0.5f && length < 2)
      points.push_back({cloud.vertices[i], cloud.normals[i] / length});
  }
  shuffle(points, generator);
  if (points.size() > count) points.resize(count);
  return points;
}

/// The vertices' normals blended, if they agree with the triangle (they do not across a sharp edge).
Eigen::Vector3f blended_normal(const Mesh& mesh, const std::array<uint32_t, 3>& triangle,
                               const Eigen::Vector3f& face_normal, float a, float b) {
  if (mesh.normals.empty()) return face_normal;
  const Eigen::Vector3f blend =
      (1 - a - b) * mesh.normals[triangle[0]] + a * mesh.normals[triangle[1]] + b * mesh.normals[triangle[2]];
  const float length = blend.norm();
  const bool agrees = length > 0.1f && blend.dot(face_normal) > 0.8f * length;
  return agrees ? Eigen::Vector3f(blend / length) : face_normal;
}

/// The first of the points that lie farthest along a direction. In lanes, which the compiler vectorises.
uint32_t farthest_along(const Eigen::Vector3f& d, const std::vector<float>& x, const std::vector<float>& y,
                        const std::vector<float>& z) {
  constexpr size_t kBlock = 512, kLanes = 8;
  uint32_t farthest = 0;
  float most = -std::numeric_limits<float>::infinity();
  std::array<float, kBlock> along;
  for (size_t begin = 0; begin < x.size(); begin += kBlock) {
    const size_t count = std::min(kBlock, x.size() - begin);
    for (size_t i = 0; i < count; ++i)
      along[i] = x[begin + i] * d[0] + (y[begin + i] * d[1] + z[begin + i] * d[2]);
    for (size_t i = count; i < kBlock; ++i) along[i] = -std::numeric_limits<float>::infinity();
    std::array<float, kLanes> lane;
    lane.fill(-std::numeric_limits<float>::infinity());
    for (size_t i = 0; i < kBlock; i += kLanes)
      for (size_t k = 0; k < kLanes; ++k) lane[k] = along[i + k] > lane[k] ? along[i + k] : lane[k];
    const float block_most = *std::max_element(lane.begin(), lane.end());
    if (block_most <= most) continue;
    most = block_most;
    farthest = static_cast<uint32_t>(begin + (std::find(along.begin(), along.end(), most) - along.begin()));
  }
  return farthest;
}

}  // namespace

std::vector<OrientedPoint> sample_surface(const Mesh& mesh, size_t count, uint64_t seed) {
  std::mt19937_64 generator(seed);
  if (mesh.triangles.empty()) return sample_cloud(mesh, count, generator);

  std::vector<double> area_up_to;  // cumulative
  double total = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]].cast<double>(), b = mesh.vertices[t[1]].cast<double>(),
                          c = mesh.vertices[t[2]].cast<double>();
    const double area = (b - a).cross(c - a).norm() / 2;
    total += std::isfinite(area) ? area : 0;
    area_up_to.push_back(total);
  }
  if (!(total > 0)) throw std::invalid_argument("expected a mesh with surface, found an area of zero");

  std::vector<OrientedPoint> points;
  points.reserve(count);
  for (size_t i = 0; i < count; ++i) {
    // Stratified along the cumulated area: evener than independent draws.
    const double target =
        (static_cast<double>(i) + unit_random(generator)) / static_cast<double>(count) * total;
    const size_t k =
        std::min<size_t>(static_cast<size_t>(std::upper_bound(area_up_to.begin(), area_up_to.end(), target) -
                                             area_up_to.begin()),
                         mesh.triangles.size() - 1);
    float a = static_cast<float>(unit_random(generator)), b = static_cast<float>(unit_random(generator));
    if (a + b > 1) a = 1 - a, b = 1 - b;
    const auto& t = mesh.triangles[k];
    const Eigen::Vector3f edge1 = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Eigen::Vector3f edge2 = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const Eigen::Vector3d cross = edge1.cast<double>().cross(edge2.cast<double>());
    if (!(cross.norm() > 0)) continue;
    const Eigen::Vector3f face_normal = cross.normalized().cast<float>();
    points.push_back(
        {mesh.vertices[t[0]] + a * edge1 + b * edge2, blended_normal(mesh, t, face_normal, a, b)});
  }
  shuffle(points, generator);
  return points;
}

std::vector<uint32_t> thin_out(const std::vector<OrientedPoint>& points, const std::vector<float>& steps) {
  std::vector<uint32_t> kept;
  std::vector<bool> taken(points.size(), false);
  for (float step : steps) {
    PointGrid grid(step);
    for (uint32_t k : kept) grid.add(points[k].position, k);
    for (uint32_t i = 0; i < points.size(); ++i) {
      if (taken[i]) continue;
      bool free = true;
      grid.visit_near(points[i].position, [&](uint32_t k) {
        // Opposite sides of a thin wall do not crowd each other out.
        const bool near = (points[k].position - points[i].position).squaredNorm() < step * step;
        return free = !(near && points[k].normal.dot(points[i].normal) > 0);
      });
      if (!free) continue;
      taken[i] = true;
      kept.push_back(i);
      grid.add(points[i].position, i);
    }
  }
  return kept;
}

std::vector<OrientedPoint> smooth_normals(const std::vector<OrientedPoint>& points,
                                          const std::vector<uint32_t>& of, float radius, int threads) {
  PointGrid grid(radius);
  for (uint32_t i = 0; i < points.size(); ++i) grid.add(points[i].position, i);
  std::vector<OrientedPoint> smoothed(of.size());
  parallel_for(of.size(), threads, [&](size_t i) {
    const OrientedPoint& centre = points[of[i]];
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    grid.visit_near(centre.position, [&](uint32_t k) {
      const bool near = (points[k].position - centre.position).squaredNorm() <= radius * radius;
      if (near && points[k].normal.dot(centre.normal) > 0) sum += points[k].normal;
      return true;
    });
    smoothed[i] = {centre.position, sum.norm() > 0 ? Eigen::Vector3f(sum.normalized()) : centre.normal};
  });
  return smoothed;
}

float largest_distance(const std::vector<OrientedPoint>& points) {
  if (points.empty()) return 0;
  // The ends of the diameter are extreme in its direction: only points that are extreme in one of many
  // directions are compared. Off by less than 0.1 % (half the angle between neighbouring directions is 2.5
  // degrees).
  std::vector<float> x, y, z;
  for (const auto& p : points)
    x.push_back(p.position.x()), y.push_back(p.position.y()), z.push_back(p.position.z());
  std::vector<uint32_t> extremes;
  for (const Eigen::Vector3f& direction : view_directions(1000))
    extremes.push_back(farthest_along(direction, x, y, z));
  float best = 0;
  for (uint32_t a : extremes)
    for (uint32_t b : extremes)
      best = std::max(best, (points[a].position - points[b].position).squaredNorm());
  return std::sqrt(best);
}

}  // namespace edgepose
