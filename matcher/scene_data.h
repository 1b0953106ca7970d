#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "matcher/oriented_point.h"
#include "matcher/scene.h"
#include "matcher/scene_samples.h"

namespace edgepose {

/// What kind of edge a pixel lies on. The far side of a depth jump is no edge of the surface behind it, only
/// the occluder's shadow, so it stays kNone.
enum class EdgeKind : uint8_t { kNone = 0, kOccluding = 1, kBoundary = 2, kCrease = 3 };

/// Typical residual of the plane fits over depth: most sensors measure worse the farther they look.
struct NoiseCurve {
  static constexpr int kBins = 20;
  static constexpr float kNearest =
      0.05f;                         ///< [m] start of the first bin; each bin spans a factor of sqrt(2)
  std::array<float, kBins> sigma{};  ///< [m]

  static int bin(float z) {  // floor(2 log2(z / kNearest)), read off the float's exponent and mantissa
    const uint32_t bits = std::bit_cast<uint32_t>(std::max(z, kNearest) / kNearest);
    constexpr uint32_t kSqrt2 = 0x3504f3;  // mantissa of sqrt(2)
    const int octave = static_cast<int>(bits >> 23) - 127;
    return std::min(2 * octave + ((bits & 0x7fffff) >= kSqrt2 ? 1 : 0), kBins - 1);
  }
  float at(float z) const { return sigma[bin(z)]; }
};

/// The preprocessed image; all arrays are row-major with width * height elements.
struct Scene::Data {
  int width = 0, height = 0;
  Camera camera;
  std::vector<float> depth;              ///< [m] as measured, 0 where nothing was
  std::vector<float> smooth_depth;       ///< [m] of the fitted plane; 0 where there is no normal
  std::vector<Eigen::Vector3f> normals;  ///< unit, towards the camera; zero where too few neighbours agree
  std::vector<EdgeKind> edges;
  NoiseCurve noise;             ///< sensor noise and quantisation, read off the plane fits
  double seconds = 0;           ///< wall time of the preprocessing
  mutable SampleCache samples;  ///< made for the models that are asked for

  size_t index(int u, int v) const { return static_cast<size_t>(v) * width + u; }
  bool inside(int u, int v) const { return u >= 0 && v >= 0 && u < width && v < height; }
  /// The ray through a pixel, z = 1.
  Eigen::Vector3f ray(int u, int v) const {
    return {(static_cast<float>(u) - static_cast<float>(camera.cx)) / static_cast<float>(camera.fx),
            (static_cast<float>(v) - static_cast<float>(camera.cy)) / static_cast<float>(camera.fy), 1.f};
  }
  Eigen::Vector3f point(int u, int v) const { return depth[index(u, v)] * ray(u, v); }
  Eigen::Vector3f smooth_point(int u, int v) const { return smooth_depth[index(u, v)] * ray(u, v); }
  /// Metres that a pixel spans at this depth.
  float pixel_size(float z) const { return z / static_cast<float>(camera.fx); }
};

}  // namespace edgepose
