#include "files/drill_plan.h"

#include <gmock/gmock.h>

#include <numbers>

#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

const std::string kPlan = R"({
  "model": "phantom", "model_diameter_mm": 93.5, "remark": "others ignored",
  "targets": [
    {"name": "left", "entry_mm": [-14, 12.5, 8], "axis": [0, -2, 0], "depth_mm": 35, "diameter_mm": 3.5,
     "tolerance_mm": 1, "tolerance_deg": 3},
    {"name": "right", "entry_mm": [14, 12.5, 8], "axis": [0, -1, 0], "depth_mm": 35, "diameter_mm": 3.5,
     "tolerance_mm": 1, "tolerance_deg": 3}]})";

TEST(DrillPlan, ReadsInSiUnits) {
  const DrillPlan plan = parse_drill_plan(kPlan, "plan.json");
  EXPECT_EQ(plan.model, "phantom");
  EXPECT_DOUBLE_EQ(plan.model_diameter, 0.0935);
  ASSERT_EQ(plan.targets.size(), 2u);
  const DrillTarget& target = plan.targets[0];
  EXPECT_EQ(target.name, "left");
  EXPECT_TRUE(target.entry.isApprox(Eigen::Vector3d(-0.014, 0.0125, 0.008)));
  EXPECT_TRUE(target.axis.isApprox(-Eigen::Vector3d::UnitY()));
  EXPECT_DOUBLE_EQ(target.depth, 0.035);
  EXPECT_DOUBLE_EQ(target.diameter, 0.0035);
  EXPECT_DOUBLE_EQ(target.position_tolerance, 0.001);
  EXPECT_DOUBLE_EQ(target.angle_tolerance, std::numbers::pi / 60);
}

TEST(DrillPlan, WritesAndReadsBack) {
  const TemporaryFolder folder;
  const DrillPlan plan = parse_drill_plan(kPlan, "plan.json");
  write_drill_plan(folder / "plan.json", plan);
  const DrillPlan read = read_drill_plan(folder / "plan.json");
  EXPECT_EQ(format_drill_plan(read), format_drill_plan(plan));
  ASSERT_EQ(read.targets.size(), 2u);
  EXPECT_LT((read.targets[1].entry - plan.targets[1].entry).norm(), 1e-11);
  EXPECT_NEAR(read.targets[1].angle_tolerance, plan.targets[1].angle_tolerance, 1e-9);
  EXPECT_THAT(file_content(folder / "plan.json"), testing::HasSubstr("\"model_diameter_mm\": 93.5,"));
}

TEST(DrillPlan, RefusesUnsoundPlans) {
  const std::pair<std::string, const char*> cases[] = {
      {replaced(kPlan, "[0, -2, 0]", "[0, 0, 0]"), "targets[0]: axis: expected a direction"},
      {replaced(kPlan, "[0, -2, 0]", "[0, -2]"), "an array of 2"},
      {replaced(kPlan, "[0, -2, 0]", "[1.7e308, 1.7e308, 1.7e308]"), "axis: expected a direction"},
      {replaced(kPlan, "\"depth_mm\": 35", "\"depth_mm\": 1e-322"), "targets[0]: depth_mm"},
      {replaced(kPlan, "[0, -2, 0]", "[0, NaN, 0]"), "JSON"},
      {replaced(kPlan, "[-14, 12.5, 8]", "[-14, null, 8]"), "entry_mm[1]"},
      {replaced(kPlan, "[-14, 12.5, 8]", "[-14, 1e400, 8]"), "JSON"},
      {replaced(kPlan, "[-14, 12.5, 8]", "[-14, 1e300, 8]"), "10 km"},
      {replaced(kPlan, "[-14, 12.5, 8]", "[-140, 12.5, 8]"), "154 mm apart"},
      {replaced(kPlan, "\"depth_mm\": 35", "\"depth_mm\": -35"), "targets[0]: depth_mm"},
      {replaced(kPlan, "\"depth_mm\": 35", "\"depth_mm\": 0"), "targets[0]: depth_mm"},
      {replaced(kPlan, "\"depth_mm\": 35", "\"depth_mm\": 35000"), "millimetres"},
      {replaced(kPlan, "\"depth_mm\": 35", "\"depth\": 35"), "\"depth_mm\""},
      {replaced(kPlan, "\"diameter_mm\": 3.5", "\"diameter_mm\": -1"), "targets[0]: diameter_mm"},
      {replaced(kPlan, "\"tolerance_mm\": 1", "\"tolerance_mm\": 0"), "targets[0]: tolerance_mm"},
      {replaced(kPlan, "\"tolerance_deg\": 3", "\"tolerance_deg\": 91"), "90 degrees"},
      {replaced(kPlan, "\"tolerance_deg\": 3", "\"tolerance_deg\": -3"), "targets[0]: tolerance_deg"},
      {replaced(kPlan, "\"right\"", "\"left\""), "'left' again"},
      {replaced(kPlan, "\"right\"", "\" \""), "targets[1]: name"},
      {replaced(kPlan, "\"right\"", "5"), "targets[1]: name"},
      {replaced(kPlan, "93.5", "0"), "model_diameter_mm"},
      {replaced(kPlan, "93.5", "0.0935"), "28 mm apart"},
      {replaced(kPlan, "\"phantom\"", "\"\""), "model"},
      {R"({"model": "m", "model_diameter_mm": 90, "targets": []})", "1 to 1000 targets"},
      {R"({"model": "m", "model_diameter_mm": 90, "targets": {}})", "an array"},
      {R"({"model": "m", "model_diameter_mm": 90})", "\"targets\""},
      {kPlan.substr(0, 200), "cut short"},
      {"", "JSON"}};
  for (const auto& [text, found] : cases)
    expect_input_error([&] { parse_drill_plan(text, "plan.json"); }, {"plan.json", found});
  expect_input_error([] { read_drill_plan("no_plan.json"); }, {"no_plan.json", "no such file"});
}

TEST(DrillPlan, MustFitTheModel) {
  const DrillPlan plan = parse_drill_plan(kPlan, "plan.json");
  const Eigen::Vector3d centre(0, 0.01, 0);
  EXPECT_NO_THROW(check_drill_plan(plan, centre, 0.0935, "plan.json"));
  EXPECT_NO_THROW(check_drill_plan(plan, centre, 0.0915, "plan.json"));
  expect_input_error([&] { check_drill_plan(plan, centre, 0.2, "plan.json"); },
                     {"200 mm", "93.5 mm", "another model"});
  expect_input_error(
      [&] {
        check_drill_plan(plan, {0, 0, 0.3}, 0.0935, "plan.json");
      },
      {"'left'", "model's centre"});
  DrillPlan deep = plan;
  deep.targets[1].depth = 0.2;
  expect_input_error([&] { check_drill_plan(deep, centre, 0.0935, "plan.json"); },
                     {"'right'", "model's centre"});
}

TEST(DrillPlan, SurvivesRandomDamage) {
  EXPECT_GT(survive_damage(kPlan, 4000,
                           [](const std::string& text) {
                             for (const DrillTarget& target : parse_drill_plan(text, "d.json").targets)
                               EXPECT_NEAR(target.axis.norm(), 1, 1e-9);
                           }),
            1000);
}

}  // namespace
}  // namespace edgepose
