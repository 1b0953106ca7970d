#include "files/point_spread.h"

#include <cmath>
#include <numbers>

namespace edgepose {
namespace {

// Directions over the half sphere about 2.5 degrees apart: the ends of the diameter stick out along one that
// is at most 2.5 degrees off, so the extent along it is at least cos(2.5 deg) = 0.999 of the diameter.
constexpr int kDirections = 2000;

Eigen::Vector3f spiral_direction(int i) {
  const double z = (i + 0.5) / kDirections;
  const double turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
  const double radius = std::sqrt(1 - z * z);
  return Eigen::Vector3d(radius * std::cos(turn), radius * std::sin(turn), z).cast<float>();
}

Eigen::Vector3f farthest_from(const Eigen::Vector3f& from, const std::vector<Eigen::Vector3f>& points) {
  const Eigen::Vector3f* best = &points.front();
  for (const Eigen::Vector3f& point : points)
    if ((point - from).squaredNorm() > (*best - from).squaredNorm()) best = &point;
  return *best;
}

}  // namespace

double largest_spread(const std::vector<Eigen::Vector3f>& points) {
  if (points.size() < 2) return 0;
  Eigen::Vector3f a = points.front(), b = a;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector3f direction = spiral_direction(i);
    const Eigen::Vector3f *low = &points.front(), *high = low;
    float lowest = direction.dot(*low), highest = lowest;
    for (const Eigen::Vector3f& point : points) {
      const float along = direction.dot(point);
      if (along < lowest) lowest = along, low = &point;
      if (along > highest) highest = along, high = &point;
    }
    if ((*high - *low).squaredNorm() > (b - a).squaredNorm()) a = *low, b = *high;
  }
  // Walk to the true ends: each step lengthens the pair.
  for (float length = -1; (b - a).norm() > length;) {
    length = (b - a).norm();
    a = farthest_from(b, points);
    b = farthest_from(a, points);
  }
  return (b.cast<double>() - a.cast<double>()).norm();
}

}  // namespace edgepose
