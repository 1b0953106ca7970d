#include "calibration/hand_eye_file.h"
#include "calibration/teach_file.h"
#include "fuzz/input_check.h"
#include "servoing/proper_pose.h"

namespace {

using namespace edgepose;

void check(const std::vector<TaughtReference>& references) {
  must_hold(!references.empty());
  for (const TaughtReference& reference : references) {
    must_hold(!reference.name.empty() && is_proper(reference.model_T_tool));
    for (const RigidTransform& pose : reference.camera_T_model) must_hold(is_proper(pose));
  }
}

}  // namespace

/// Each reader on the same bytes: what is read is sound, can be written and read again.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view text = text_of(data, size);
  static const ArmGeometry arm = aubo_i5();
  reads([&] {
    const HandEyeFile file = parse_hand_eye(text, "in.json");
    must_hold(is_proper(file.flange_T_camera) && file.samples >= 3 && file.made.size() == 20);
    must_hold(reads([&] { parse_hand_eye(format_hand_eye(file), "again.json"); }));
  });
  reads([&] {
    const ToolFile tool = parse_tool(text, "in.json");
    must_hold(is_proper(tool.flange_T_tool));
    must_hold(reads([&] { parse_tool(format_tool(tool), "again.json"); }));
  });
  reads([&] {
    for (const HandEyeSample& sample : parse_hand_eye_samples(text, "in.json", arm))
      must_hold(is_proper(sample.base_T_flange) && is_proper(sample.camera_T_target));
  });
  reads([&] { check(parse_teach_record(text, "in.json").references); });
  reads([&] {
    const TaughtFile file = parse_taught(text, "in.json");
    must_hold(is_proper(file.taught.camera_T_tool));
    must_hold(reads([&] { parse_taught(format_taught(file), "again.json"); }));
  });
  return 0;
}
