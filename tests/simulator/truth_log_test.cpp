#include "simulator/truth_log.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/error.h"
#include "messaging/transform_message.h"
#include "tests/simulator/cell.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

TruthSample moving(const WorkCell& cell) {
  TruthSample sample;
  sample.time_ns = 5'000'000;
  sample.position = cell.nominal;
  sample.velocity[0] = 0.1;
  sample.states.fill(DriveState::kOperationEnabled);
  return sample;
}

TEST(TruthLog, WritesOneLineASample) {
  const TemporaryFolder folder;
  const WorkCell cell = phantom_cell();
  {
    TruthLog log(folder / "truth.csv", cell, cell.find_target(cell.target));
    for (int i = 0; i < 100; ++i) log.add(moving(cell));
    EXPECT_EQ(log.lost(), 0u);
  }
  std::ifstream file(folder / "truth.csv");
  std::string header, line;
  std::getline(file, header);
  int lines = 0;
  for (std::string next; std::getline(file, next); ++lines) line = next;
  EXPECT_EQ(lines, 100);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(line.begin(), line.end(), ','));
  std::vector<double> values;
  std::istringstream text(line);
  for (std::string value; std::getline(text, value, ',');) values.push_back(std::stod(value));
  ASSERT_EQ(values.size(), 23u);
  EXPECT_EQ(values[0], 5e6);
  EXPECT_NEAR(values[3], cell.nominal[2], 1e-8);
  EXPECT_EQ(values[7], 0.1);
  EXPECT_EQ(values[13], 5);
  EXPECT_NEAR(values[19], 0, 1e-9);
  // Joint 1 turns about z of the base: the tip is its radius away.
  const double radius = base_T_tool(cell, cell.nominal).translation().head<2>().norm();
  EXPECT_NEAR(values[22], 0.1 * radius, 1e-6);
}

TEST(TruthLog, RefusesAFolderThatIsNotThere) {
  const WorkCell cell = phantom_cell();
  EXPECT_THROW(TruthLog("/nowhere/truth.csv", cell, cell.plan.targets[0]), InputError);
}

TEST(TruthLog, CountsWhatAFullDiskLost) {
  const WorkCell cell = phantom_cell();
  TruthLog log("/dev/full", cell, cell.plan.targets[0]);
  for (int i = 0; i < 1000; ++i) log.add(moving(cell));
  for (int i = 0; i < 500 && log.lost() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_GT(log.lost(), 0u);
}

TEST(TruthMessage, IsTheTruth) {
  const WorkCell cell = phantom_cell();
  const auto m = truth_message(cell, cell.plan.targets[1], moving(cell), 42);
  EXPECT_EQ(m.utime, 42);
  EXPECT_EQ(m.target, "right_pedicle_screw");
  EXPECT_EQ(m.drive_state[5], 5);
  EXPECT_TRUE(from_message(m.camera_T_model)->isApprox(camera_T_model(cell, cell.nominal), 1e-9));
  EXPECT_NEAR(m.tip_across, positioning_error(cell, cell.nominal, cell.plan.targets[1]).across, 1e-12);
}

}  // namespace
}  // namespace edgepose
