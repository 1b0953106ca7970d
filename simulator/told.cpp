#include "simulator/told.h"

#include <nlohmann/json.hpp>

#include "arm/rigid_motion.h"
#include "calibration/hand_eye_file.h"
#include "common/atomic_file.h"
#include "common/error.h"
#include "matcher/option_range.h"
#include "simulator/random_draws.h"

namespace edgepose {
namespace {

/// As the paper: noise on each component of rotation vector and translation.
RigidTransform disturbed(const RigidTransform& truth, double sigma, RandomDraws draws) {
  const Eigen::Vector3d turn = draws.gauss(sigma), shift = draws.gauss(sigma);
  return rigid_transform(rotation_matrix(rotation_vector(truth.linear()) + turn),
                         truth.translation() + shift);
}

}  // namespace

std::string ToldNoise::check() const {
  return option_fault({{"focal_px", focal_px, 0, 50},
                       {"centre_px", centre_px, 0, 50},
                       {"hand_eye", hand_eye, 0, 0.1},
                       {"tool", tool, 0, 0.1}});
}

ToldEquipment draw_told(const WorkCell& cell, const ToldNoise& noise, uint64_t seed) {
  if (const std::string fault = noise.check(); !fault.empty()) throw InputError("told noise: " + fault);
  ToldEquipment told;
  RandomDraws draws(seed, DrawPurpose::kIntrinsics);
  told.camera = cell.camera;
  told.camera.fx += noise.focal_px * draws.normal();
  told.camera.fy += noise.focal_px * draws.normal();
  told.camera.cx += noise.centre_px * draws.normal();
  told.camera.cy += noise.centre_px * draws.normal();
  told.flange_T_camera = disturbed(cell.flange_T_camera, noise.hand_eye, {seed, DrawPurpose::kHandEye});
  told.flange_T_tool = disturbed(cell.flange_T_tool, noise.tool, {seed, DrawPurpose::kTool});
  return told;
}

void write_told(const std::filesystem::path& folder, const ToldEquipment& told, const std::string& made) {
  HandEyeFile hand_eye;
  hand_eye.made = made;
  hand_eye.method = "told by the simulator";
  hand_eye.flange_T_camera = told.flange_T_camera;
  hand_eye.samples = 3;
  const ToolFile tool{made, "simulated drill, told by the simulator", told.flange_T_tool};
  nlohmann::ordered_json camera;
  camera["fx"] = told.camera.fx, camera["fy"] = told.camera.fy;
  camera["cx"] = told.camera.cx, camera["cy"] = told.camera.cy;
  camera["depth_scale"] = 1.0;
  FileGroup files;
  files.make_folder(folder);
  files.add(folder / "hand-eye.json", std::string_view(format_hand_eye(hand_eye)));
  files.add(folder / "tool.json", std::string_view(format_tool(tool)));
  files.add(folder / "camera.json", std::string_view(camera.dump(1, '\t') + "\n"));
  files.commit();
}

}  // namespace edgepose
