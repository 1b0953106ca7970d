#include <cmath>

#include "files/bop_json.h"
#include "files/uwa_set.h"
#include "fuzz/input_check.h"

namespace {

using namespace edgepose;

void check_rigid(const RigidTransform& pose) {
  must_hold((pose.linear().transpose() * pose.linear() - Eigen::Matrix3d::Identity()).norm() < 1e-9);
  must_hold(pose.linear().determinant() > 0);
  must_hold(pose.translation().norm() <= 1000);
}

void check_objects(std::string_view text) {
  for (const TestObject& object : parse_bop_objects(text, "models_info.json")) {
    must_hold(object.id >= 0 && object.diameter > 0 && object.diameter <= 1000);
    must_hold(object.symmetric == !object.symmetries.empty());
    for (const RigidTransform& symmetry : object.symmetries.discrete) check_rigid(symmetry);
    for (const SymmetryAxis& axis : object.symmetries.continuous) {
      must_hold(std::abs(axis.direction.norm() - 1) < 1e-9);
      must_hold(axis.point.allFinite());
    }
  }
}

void check_cameras(std::string_view text) {
  for (const auto& [image, camera] : parse_bop_cameras(text, "scene_camera.json"))
    must_hold(image >= 0 && camera.camera.fx > 0 && camera.camera.fy > 0 && camera.depth_scale > 0);
}

void check_truth(std::string_view text) {
  for (const auto& [image, instances] : parse_bop_truth(text, "scene_gt.json"))
    for (const GroundTruth& instance : instances) check_rigid(instance.camera_T_model);
}

void check_visibility(std::string_view text) {
  std::map<int, std::vector<GroundTruth>> truth = {{0, std::vector<GroundTruth>(2)}, {1, {}}};
  reads([&] { add_bop_visibility(text, "scene_gt_info.json", truth); });
  for (const GroundTruth& instance : truth[0])
    must_hold(instance.visible_share >= 0 && instance.visible_share <= 1);
}

}  // namespace

/// The first byte chooses the file, the rest is its content.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const std::string_view text = text_of(data + 1, size - 1);
  switch (data[0]) {
    case 'o':
      reads([&] { check_objects(text); });
      break;
    case 'c':
      reads([&] { check_cameras(text); });
      break;
    case 't':
      reads([&] { check_truth(text); });
      break;
    case 'v':
      check_visibility(text);
      break;
    case 'x':
      reads([&] { check_rigid(parse_xf(text, "object-scene.xf")); });
      break;
    default:
      return -1;  // not worth keeping
  }
  return 0;
}
