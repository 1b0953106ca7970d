#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>

#include "common/error.h"
#include "demo/child_program.h"
#include "demo/csv_table.h"
#include "demo/demo_options.h"
#include "demo/run_track.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

using testing::HasSubstr;

template <class Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "not refused";
}

std::filesystem::path written(const TemporaryFolder& folder, const std::string& name,
                              const std::string& text) {
  std::ofstream(folder / name) << text;
  return folder / name;
}

/// A line of the controller's log: what is not told of is 0.
std::string control_line(int64_t ms, const std::string& state, double tool_error) {
  std::string line = std::to_string(1000000 * ms) + "," + state + ",ready,none,1,0.04," +
                     std::to_string(tool_error) + ",0.1";
  for (int i = 1; i <= 12; ++i) line += "," + std::to_string(i);
  return line + "\n";
}
constexpr const char* kControlHeading =
    "time_ns,state,phase,fault,goal_seen,standoff_m,tool_error_m,tool_angle_rad,feature1,feature2,feature3,"
    "feature4,feature5,feature6,camera_velocity1,camera_velocity2,camera_velocity3,camera_velocity4,"
    "camera_velocity5,camera_velocity6\n";
constexpr const char* kTruthHeading = "time_ns,q1,q2,q3,q4,q5,q6,along_m,across_m,angle_rad\n";

std::string truth_line(int64_t ms, double along, double across) {
  return std::to_string(1000000 * ms) + ",1,2,3,4,5,6," + std::to_string(along) + "," +
         std::to_string(across) + ",0.01\n";
}

TEST(CsvTable, ReadsNumbersAndTextAndLeavesOutHalfALine) {
  const TemporaryFolder folder;
  const CsvTable table(written(folder, "a.csv", "t,name,x\n1,on,-2.5e-3\n2,off,nan\n3,of"));
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.text(1, table.column("name")), "off");
  EXPECT_EQ(table.number(0, table.column("x")), -2.5e-3);
  EXPECT_TRUE(std::isnan(table.number(0, table.column("name"))));
}

TEST(CsvTable, SaysWhichLineOrColumnIsWrong) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal([&] { CsvTable(written(folder, "a.csv", "t,x\n1,2\n1,2,3\n")); }),
              HasSubstr("a.csv, line 3: expected 2 fields, found 3"));
  const CsvTable table(written(folder, "b.csv", "t,x\n1,2\n"));
  EXPECT_THAT(refusal([&] { (void)table.column("y"); }), HasSubstr("b.csv: expected a column y"));
}

TEST(RunTrack, BeginsWhenTheArmSetsOutAndEndsWhenTold) {
  const TemporaryFolder folder;
  std::string control = kControlHeading, truth = kTruthHeading;
  for (int ms = 0; ms <= 3000; ms += 5)
    control += control_line(ms, ms < 1000 ? "armed" : ms < 2000 ? "approaching" : "converged", 1e-3 * ms);
  for (int ms = 0; ms <= 3000; ++ms) truth += truth_line(ms, 0.003, 1e-6 * ms);
  const RunTrack track =
      read_track(written(folder, "arm.csv", control), written(folder, "truth.csv", truth), 2'500'000'000);
  EXPECT_NEAR(track.end(), 1.5, 1e-6);
  EXPECT_NEAR(track.converged(), 1.0, 0.021);
  EXPECT_NEAR(track.control_at(0.5).tool_error, 1.5, 0.011);
  EXPECT_EQ(track.control_at(0.5).features, (std::array<double, 6>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(track.control_at(0.5).velocity, (std::array<double, 6>{7, 8, 9, 10, 11, 12}));
  EXPECT_NEAR(track.truth_at(0.5).across, 0.0015, 1.1e-5);
  EXPECT_NEAR(track.truth_at(9).distance(), std::hypot(0.003, 0.0025), 1e-6);
  EXPECT_EQ(track.truth.back().joints[5], 6);
}

TEST(RunTrack, RefusesAnArmThatNeverSetOut) {
  const TemporaryFolder folder;
  const auto control = written(folder, "arm.csv", kControlHeading + control_line(1, "armed", 0));
  const auto truth = written(folder, "truth.csv", kTruthHeading + truth_line(1, 0, 0));
  EXPECT_THAT(refusal([&] { read_track(control, truth, 1'000'000'000); }),
              HasSubstr("expected an arm that set out"));
}

TEST(ChildProgram, TellsTheLastWordsOfOneThatEnded) {
  const TemporaryFolder folder;
  ChildProgram child("/bin/sh", {"-c", "echo one; echo two >&2; exit 3"}, folder / "log");
  EXPECT_EQ(child.wait(20), 3);
  EXPECT_THAT(refusal([&] { child.check(); }), HasSubstr("sh ended with exit code 3: one two"));
}

TEST(ChildProgram, KillsOneThatDoesNotEnd) {
  const TemporaryFolder folder;
  ChildProgram child("/bin/sh", {"-c", "trap '' TERM; echo up; while :; do sleep 0.1; done"}, folder / "log");
  while (std::filesystem::file_size(folder / "log") == 0) ASSERT_FALSE(child.wait(0.01));
  EXPECT_EQ(child.end(0.2), -SIGKILL);
}

TEST(ChildProgram, RefusesWhatIsNoProgram) {
  const TemporaryFolder folder;
  EXPECT_THAT(refusal([&] { ChildProgram(folder / "nobody", {}, folder / "log"); }),
              HasSubstr("nobody: expected a program, found No such file"));
}

TEST(DemoOptions, NameWhatIsMissingOrWrong) {
  DemoOptions options;
  EXPECT_THAT(options.check(), HasSubstr("give a mesh and its drill plan"));
  options.cell.model = "bone.ply";
  EXPECT_THAT(options.check(), HasSubstr("found only --mesh"));
  options.cell.plan = "plan.json";
  EXPECT_EQ(options.check(), "");
  options.seconds = 0;
  EXPECT_THAT(options.check(), HasSubstr("seconds"));
}

}  // namespace
}  // namespace edgepose
