#include "models/phantom/phantom_shape.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace edgepose::phantom {
namespace {

using Eigen::Vector3d;

double length(double x, double y) { return std::sqrt(x * x + y * y); }
double length(const Vector3d& v) { return std::sqrt(v.x() * v.x() + v.y() * v.y() + v.z() * v.z()); }

/// Union, intersection and difference with a fillet of about `fillet` mm (polynomial smooth minimum).
double join(double a, double b, double fillet) {
  const double h = std::max(fillet - std::abs(a - b), 0.0) / fillet;
  return std::min(a, b) - h * h * fillet / 4;
}
double intersect(double a, double b, double fillet) { return -join(-a, -b, fillet); }
double cut(double a, double b, double fillet) { return intersect(a, -b, fillet); }

/// Ellipsoid; exact on the surface, an estimate elsewhere.
double ellipsoid(const Vector3d& p, const Vector3d& radii) {
  const Vector3d scaled = p.cwiseQuotient(radii), twice = scaled.cwiseQuotient(radii);
  const double k = length(scaled), gradient = length(twice);
  return gradient > 0 ? k * (k - 1) / gradient : -radii.minCoeff();
}

/// Rod from a to b whose radius goes from radius_a to radius_b, flattened along x, y, z by `squash`.
double rounded_rod(const Vector3d& p, const Vector3d& a, const Vector3d& b, double radius_a, double radius_b,
                   const Vector3d& squash) {
  const Vector3d q = (p - a).cwiseQuotient(squash), along = (b - a).cwiseQuotient(squash);
  const double t = std::clamp(q.dot(along) / along.dot(along), 0.0, 1.0);
  return (length(Vector3d(q - t * along)) - (radius_a + t * (radius_b - radius_a))) * squash.minCoeff();
}

/// Waisted elliptic cylinder with a flattened back and slightly hollow end plates.
double vertebral_body(const Vector3d& p) {
  const double height = p.z() / 14;
  const double waist = 0.87 + 0.13 * std::min(height * height, 1.2);
  const double x = p.x() / (23.5 * waist), y = p.y() / (17 * waist);
  double side = (length(x, y) - 1) * 17;
  side = cut(side, ellipsoid(p - Vector3d(0, 24, 0), {16, 9.5, 60}), 3);
  const double hollow = 2.0 * std::max(0.0, 1 - x * x - y * y);
  const double plates = std::abs(p.z()) - (14.5 - hollow);
  return intersect(side, plates, 4);
}

/// Everything behind the body that a right and a left side share; p.x() >= 0.
double half_arch(const Vector3d& p) {
  const double pedicle = rounded_rod(p, {14.5, 10, 5}, {16, 29, 4.5}, 5.2, 5.4, {1, 1, 1.45});
  const double lamina = rounded_rod(p, {13, 31, 2}, {0, 40, -4}, 3.9, 3.9, {1, 1, 2.3});
  const double superior = rounded_rod(p, {17, 31, 6}, {19, 33.5, 19}, 5.8, 4.6, {1, 1.1, 1});
  const double superior_facet = ellipsoid(p - Vector3d(13, 42, 21), {6, 11, 12});  // hollow facet
  const double inferior = rounded_rod(p, {12.5, 36, -8}, {12, 38.5, -23}, 5, 4.4, {1, 1, 1});
  double arch = join(pedicle, lamina, 5);
  arch = join(arch, cut(superior, superior_facet, 1.5), 4);
  return join(arch, inferior, 4);
}

/// Transverse processes: the left one is longer, thicker and points up, so that left and right differ.
double transverse_processes(const Vector3d& p) {
  const double left = rounded_rod(p, {17, 29, 3}, {44, 34, 8}, 5.4, 3.4, {1, 0.8, 1.25});
  const double right = rounded_rod(p, {-17, 29, 3}, {-40, 36, 1}, 5.0, 3.0, {1, 0.8, 1.25});
  return std::min(left, right);
}

/// A plate in the middle, bent a little to the right, with a blunt thickened end.
double spinous_process(const Vector3d& p) {
  const double plate = rounded_rod(p, {0, 40, -4}, {-2, 61, -10}, 3.2, 2.8, {1, 1, 2.6});
  const double end = ellipsoid(p - Vector3d(-2.2, 62, -10.5), {4, 5, 8.5});
  return join(plate, end, 4);
}

}  // namespace

double signed_distance(const Vector3d& p) {
  const Vector3d mirrored(std::abs(p.x()), p.y(), p.z());
  double bone = join(half_arch(mirrored), spinous_process(p), 5);
  bone = join(bone, transverse_processes(p), 5);
  bone = join(bone, vertebral_body(p), 4);
  bone = cut(bone, ellipsoid(p - Vector3d(0, 23.5, 0), {10.5, 8.5, 90}), 3);  // vertebral canal
  // Two marks that no real vertebra has, so that no two views are alike: a notch on the spinous process and
  // a round dent in the left front of the body.
  bone = cut(bone, ellipsoid(p - Vector3d(-2, 55, 1.5), {12, 3.2, 5}), 1.5);
  return cut(bone, ellipsoid(p - Vector3d(15, -14, 5), {5.5, 5.5, 5.5}), 1.5);
}

Vector3d outward_normal(const Vector3d& point) {
  constexpr double kStep = 1.0 / 1024;  // mm; a power of two adds no rounding of its own
  Vector3d gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Vector3d step = Vector3d::Zero();
    step[axis] = kStep;
    gradient[axis] = signed_distance(point + step) - signed_distance(point - step);
  }
  return gradient / length(gradient);
}

Vector3d first_hit(const Vector3d& origin, const Vector3d& direction) {
  constexpr double kStep = 0.05, kReach = 300;  // mm
  for (double reached = 0; reached < kReach; reached += kStep) {
    if (signed_distance(origin + reached * direction) > 0) continue;
    double outside = reached - kStep, inside = reached;
    for (int i = 0; i < 40; ++i) {
      const double middle = (outside + inside) / 2;
      (signed_distance(origin + middle * direction) > 0 ? outside : inside) = middle;
    }
    return origin + outside * direction;
  }
  throw std::runtime_error("phantom: a planned axis misses the bone");
}

}  // namespace edgepose::phantom
