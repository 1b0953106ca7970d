#include <gmock/gmock.h>

#include "arm/kinematics.h"
#include "arm/rigid_motion.h"
#include "calibration/hand_eye_file.h"
#include "calibration/teach_file.h"
#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

const std::string kHandEye = R"({"kind": "hand-eye", "made": "2026-11-23T09:30:00Z", "method": "park",
  "flange_T_camera": {"rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "translation_m": [0.08, 0, 0.06]},
  "samples": 20, "residual_rms": {"translation_m": 0.0004, "rotation_rad": 0.002},
  "residual_worst": {"translation_m": 0.0009, "rotation_rad": 0.004}, "remark": "others are ignored"})";

const std::string kTool = R"({"kind": "tool", "made": "2026-11-23T09:30:00Z", "name": "drill 3.5 mm",
  "flange_T_tool": {"rotation_vector_rad": [0, 0, 0.5], "translation_m": [0, 0, 0.2]}})";

const std::string kSamples = R"({"kind": "hand-eye-samples", "samples": [
  {"joints_rad": [0.3, -0.4, 1.4, 0.2, 1.5, 0.1],
   "camera_T_target": {"rotation_vector_rad": [3.1, 0, 0], "translation_m": [0, 0, 0.4]}},
  {"base_T_flange": {"rotation_vector_rad": [0, 3, 0], "translation_m": [0.5, 0, 0.4]},
   "camera_T_target": {"rotation_vector_rad": [3.1, 0, 0], "translation_m": [0, 0, 0.4]}}]})";

const std::string kRecord = R"({"kind": "teach-record", "model": "phantom", "references": [
  {"name": "left", "model_T_tool": {"rotation_vector_rad": [0, 0, 0], "translation_m": [0.01, 0, 0]},
   "camera_T_model": [{"rotation_vector_rad": [1, 0, 0], "translation_m": [0, 0, 0.35]}]},
  {"name": "right", "model_T_tool": {"rotation_vector_rad": [0, 0, 0], "translation_m": [0.02, 0, 0]},
   "camera_T_model": [{"rotation_vector_rad": [1, 0, 0], "translation_m": [0, 0, 0.35]}]}]})";

const std::string kTaught = R"({"kind": "taught-tool", "made": "2026-11-23T09:30:00Z", "model": "phantom",
  "camera_T_tool": {"rotation_vector_rad": [0.1, 0, 0], "translation_m": [0, 0, 0.35]},
  "references": [{"name": "left", "poses": 30, "residual_m": 0.0002, "residual_rad": 0.001, "noise_m": 0.0003,
                  "noise_rad": 0.002}]})";

TEST(CalibrationFiles, HandEyeComesBack) {
  const TemporaryFolder folder;
  const HandEyeFile file = parse_hand_eye(kHandEye, "hand_eye.json");
  EXPECT_EQ(file.made, "2026-11-23T09:30:00Z");
  EXPECT_EQ(file.samples, 20);
  EXPECT_EQ(file.flange_T_camera * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.08, 1, 0.06));
  EXPECT_DOUBLE_EQ(file.worst.rotation, 0.004);
  write_hand_eye(folder / "again.json", file);
  EXPECT_EQ(format_hand_eye(read_hand_eye(folder / "again.json")), format_hand_eye(file));
}

TEST(CalibrationFiles, ToolComesBack) {
  const ToolFile tool = parse_tool(kTool, "tool.json");
  EXPECT_LT((rotation_vector(tool.flange_T_tool.linear()) - Eigen::Vector3d(0, 0, 0.5)).norm(), 1e-12);
  const ToolFile again = parse_tool(format_tool(tool), "again.json");
  EXPECT_LT((again.flange_T_tool.matrix() - tool.flange_T_tool.matrix()).norm(), 1e-12);
  EXPECT_EQ(again.name, "drill 3.5 mm");
}

TEST(CalibrationFiles, SamplesTakeJointsOrAPoseOfTheFlange) {
  const ArmGeometry arm = aubo_i5();
  const std::vector<HandEyeSample> samples = parse_hand_eye_samples(kSamples, "samples.json", arm);
  ASSERT_EQ(samples.size(), 2u);
  const JointVector joints = (JointVector() << 0.3, -0.4, 1.4, 0.2, 1.5, 0.1).finished();
  EXPECT_EQ(samples[0].base_T_flange.matrix(), base_T_flange(arm, joints).matrix());
  EXPECT_EQ(samples[1].base_T_flange.translation(), Eigen::Vector3d(0.5, 0, 0.4));
}

TEST(CalibrationFiles, TeachRecordAndTaughtToolComeBack) {
  const TemporaryFolder folder;
  const TeachRecord record = parse_teach_record(kRecord, "record.json");
  EXPECT_EQ(record.model, "phantom");
  ASSERT_EQ(record.references.size(), 2u);
  EXPECT_EQ(record.references[1].name, "right");
  const TaughtFile taught = parse_taught(kTaught, "taught.json");
  write_taught(folder / "again.json", taught);
  const TaughtFile again = read_taught(folder / "again.json");
  EXPECT_EQ(format_taught(again), format_taught(taught));
  EXPECT_EQ(again.taught.residuals[0].poses, 30);
}

TEST(CalibrationFiles, BadInputIsOneClearLine) {
  const auto hand_eye = [](const std::string& text) { return [text] { parse_hand_eye(text, "h.json"); }; };
  expect_input_error(hand_eye(replaced(kHandEye, "[0, -1, 0]", "[0, -1, 0.2]")),
                     {"h.json: flange_T_camera: rotation", "expected a rotation matrix"});
  expect_input_error(hand_eye(replaced(kHandEye, "[0, 0, 1]]", "[0, 0, -1]]")), {"one that mirrors"});
  expect_input_error(hand_eye(replaced(kHandEye, "[0, 0, 1]]", "[0, 0, 1], [0, 0, 1]]")), {"3 rows"});
  expect_input_error(hand_eye(replaced(kHandEye, "[0.08, 0, 0.06]", "[80, 0, 60]")),
                     {"translation_m: expected at most 1 m, found 100 m", "lengths are in metres"});
  expect_input_error(hand_eye(replaced(kHandEye, "[0.08, 0, 0.06]", "[0.08, null, 0.06]")),
                     {"translation_m[1]"});
  expect_input_error(hand_eye(replaced(kHandEye, "\"hand-eye\"", "\"tool\"")),
                     {"kind: expected \"hand-eye\""});
  expect_input_error(hand_eye(replaced(kHandEye, "2026-11-23T", "23.11.2026 ")), {"made: expected a time"});
  expect_input_error(hand_eye(replaced(kHandEye, "0.0004", "-1")), {"residual_rms: translation_m"});
  expect_input_error(hand_eye(replaced(kHandEye, "\"samples\": 20", "\"samples\": 1")), {"samples"});
  expect_input_error(hand_eye("{"), {"h.json"});
  expect_input_error([] { parse_tool(replaced(kTool, "0.2]", "10]"), "tool.json"); },
                     {"tool.json: flange_T_tool: translation_m: expected at most 1 m, found 10 m"});
  expect_input_error([] { parse_tool(replaced(kTool, "[0, 0, 0.5]", "[0, 0, 30]"), "tool.json"); },
                     {"rotation_vector_rad", "are these degrees?"});
  expect_input_error(
      [] { parse_hand_eye_samples(replaced(kSamples, "0.3, -0.4", "17, -23"), "s.json", aubo_i5()); },
      {"s.json: samples[0]: joints_rad", "found 17 rad", "are these degrees?"});
  expect_input_error([] { parse_teach_record(replaced(kRecord, "\"right\"", "\"left\""), "r.json"); },
                     {"references[1]: name", "another name"});
  expect_input_error([] { read_hand_eye("/nowhere/hand_eye.json"); }, {"/nowhere/hand_eye.json"});
}

TEST(CalibrationFiles, DamageIsRefusedOrHarmless) {
  EXPECT_GT(survive_damage(kHandEye, 3000, [](const std::string& text) { parse_hand_eye(text, "d.json"); }),
            500);
  EXPECT_GT(survive_damage(kTool, 3000, [](const std::string& text) { parse_tool(text, "d.json"); }), 500);
  const ArmGeometry arm = aubo_i5();
  EXPECT_GT(survive_damage(kSamples, 3000,
                           [&](const std::string& text) { parse_hand_eye_samples(text, "d.json", arm); }),
            500);
  EXPECT_GT(
      survive_damage(kRecord, 3000, [](const std::string& text) { parse_teach_record(text, "d.json"); }),
      500);
  EXPECT_GT(survive_damage(kTaught, 3000, [](const std::string& text) { parse_taught(text, "d.json"); }),
            500);
}

}  // namespace
}  // namespace edgepose
