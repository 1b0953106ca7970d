#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Units: metres, radians, seconds. Camera frame: z forward, x right, y down. Transforms are named
/// `target_T_source` and take points from source to target (docs/frames_and_units.md).
namespace edgepose {

using RigidTransform = Eigen::Isometry3d;

/// Triangles, or a cloud if `triangles` is empty. Metres, model frame.
struct Mesh {
  std::vector<Eigen::Vector3f> vertices;
  std::vector<Eigen::Vector3f> normals;            ///< one per vertex, unit length, outwards; or empty
  std::vector<std::array<uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside
};

/// Pinhole camera without distortion. Pixel (u, v) = centre of the pixel in column u, row v.
struct Camera {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< pixels
};

/// Row-major depth along the optical axis in metres; 0 = no measurement.
struct DepthImage {
  int width = 0, height = 0;
  std::vector<float> depth;  ///< width * height values

  float at(int u, int v) const { return depth[static_cast<size_t>(v) * width + u]; }
  float& at(int u, int v) { return depth[static_cast<size_t>(v) * width + u]; }
};

}  // namespace edgepose
