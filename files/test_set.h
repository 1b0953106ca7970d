#pragma once
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "matcher/model.h"
#include "matcher/types.h"

namespace edgepose {

struct TestObject {
  int id = 0;
  std::string name;
  std::filesystem::path mesh;  ///< PLY in millimetres
  double diameter = 0;         ///< [m] largest distance between two of its points
  Symmetries symmetries;       ///< as declared by the set; metres
  bool symmetric = false;      ///< declared symmetric: ADI' instead of ADD
};

struct GroundTruth {
  int object_id = 0;
  /// Metres. For a cloud, `camera` is the cloud's own frame.
  RigidTransform camera_T_model = RigidTransform::Identity();
  double visible_share = 1;  ///< [0, 1] of the projected silhouette; 1 if the set does not tell
  int visible_pixels = std::numeric_limits<int>::max();  ///< the largest int if the set does not tell
  std::optional<double> occlusion;  ///< [0, 1] Mian's: hidden surface / whole surface, if the set tells
};

struct TestImage {
  int scene_id = 0, image_id = 0;
  std::filesystem::path depth;  ///< 16-bit PNG, or empty ...
  std::filesystem::path cloud;  ///< ... and this a PLY cloud in millimetres
  Camera camera;                ///< of the depth image; zero for a cloud
  double depth_scale = 0;       ///< [m] per unit of the depth image; 0 for a cloud
  std::vector<GroundTruth> truth;
};

struct TestSet {
  std::string name;                                 ///< of the folder
  std::vector<TestObject> objects;                  ///< by rising id; every truth's object is among them
  std::vector<TestImage> images;                    ///< by rising scene, then image
  std::vector<std::filesystem::path> descriptions;  ///< files that told of objects, cameras and truth
};

/// Reads a folder in the BOP format (files/bop_set.h) or in UWA's own layout (files/uwa_set.h), whichever it
/// is. Throws InputError that explains both if it is neither. Every file named in the result exists.
TestSet read_test_set(const std::filesystem::path& folder);

/// The last part of the path, also of "." and "sets/range/".
std::string folder_name(const std::filesystem::path& folder);

}  // namespace edgepose
