#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "files/mesh_file.h"
#include "matcher/types.h"

namespace edgepose {

/// A mesh file and where its mesh is.
struct PlacedMesh {
  std::filesystem::path mesh;
  RigidTransform camera_T_model = RigidTransform::Identity();
  int object_id = 0;  ///< as the truth file says it
};

/// "x y z rx ry rz": millimetres, and a rotation vector (axis times angle) in degrees; spaces or commas
/// between. Throws InputError.
RigidTransform parse_pose(const std::string& text);

/// A scene file: as BOP's scene_gt.json, {"IMAGE": [{"cam_R_m2c": [9], "cam_t_m2c": [3], "obj_id": N, "mesh":
/// PATH}, ...]}; the paths are relative to the file. `image` may be left out if there is one only. Throws
/// InputError.
std::vector<PlacedMesh> read_scene_file(const std::filesystem::path& path, std::optional<int> image);

/// The same from memory; `file` stands in messages, and its folder before the paths.
std::vector<PlacedMesh> parse_scene_file(std::string_view text, const std::filesystem::path& file,
                                         std::optional<int> image);

/// The same as text, with the meshes relative to `folder`.
std::string scene_file_text(const std::vector<PlacedMesh>& objects, const std::filesystem::path& folder);

}  // namespace edgepose
