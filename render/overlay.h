#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

using Colour = std::array<uint8_t, 3>;  ///< red, green, blue

/// A place to drill, drawn as a ring at the entry point and a line along the axis. Model frame, metres.
struct OverlayTarget {
  std::string name;
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< into the object; any length but 0
  double depth = 0.03;                              ///< [m]
  double diameter = 0.006;                          ///< [m]
};

/// One object that was found.
struct OverlayPose {
  const Mesh* mesh = nullptr;  ///< with triangles; must outlive the call
  RigidTransform camera_T_model = RigidTransform::Identity();
  std::string label;       ///< name, score; drawn as plain ASCII. Empty: no label
  Colour colour{0, 0, 0};  ///< black: the next one of a palette
  std::vector<OverlayTarget> targets;
};

struct OverlayOptions {
  int width = 1280;              ///< [pixels] about; the image is enlarged by the nearest whole factor
  bool zoom = true;              ///< show only the objects and their surroundings, larger
  double crease_angle_deg = 40;  ///< [degrees] edges sharper than this are drawn beside the silhouette
  bool frames = true;            ///< the model's axes: x red, y green, z blue
  double tint = 0.22;            ///< [0, 1] how strongly the visible surface takes the pose's colour
  int threads = 0;               ///< 0 = all cores; the result does not depend on it
};

struct RgbImage {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;  ///< 3 * width * height, row-major
};

/// Draws the shaded depth image and over it, for each pose, the model's silhouette and creases (faint where
/// the scene hides them), its axes, its drill targets and a label. Throws std::invalid_argument if the image,
/// the camera or a mesh is unsound.
RgbImage draw_overlay(const DepthImage& image, const Camera& camera, const std::vector<OverlayPose>& poses,
                      const OverlayOptions& options = {});

/// Over a picture of the whole image, enlarged by a whole factor, in which the poses' surfaces are drawn
/// already: the models' axes, their drill targets and labels. Throws as draw_overlay().
void annotate_overlay(RgbImage& picture, const DepthImage& image, const Camera& camera,
                      const std::vector<OverlayPose>& poses, const OverlayOptions& options = {});

/// The depth image alone, shaded by its normals and coloured by its depth (near warm, far blue), enlarged
/// `scale` times; holes are black.
RgbImage shade_depth(const DepthImage& image, const Camera& camera, int scale = 1);

/// As a PNG in memory. Throws std::invalid_argument if the picture's sizes contradict each other.
std::vector<std::byte> encode_png(const RgbImage& image);

/// Writes a PNG aside and renames it. Throws InputError if the file cannot be written.
void write_png(const std::filesystem::path& path, const RgbImage& image);

}  // namespace edgepose
