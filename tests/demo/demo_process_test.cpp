/// edgepose-servo demo as its users run it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <regex>

#include "demo/csv_table.h"
#include "tests/messaging/network_namespace.h"
#include "tests/service/daemon.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

constexpr double kMostSeconds = 240;  // on a machine that does much else

class DemoProcess : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network()) GTEST_SKIP() << "no network of its own on this machine";
  }
  Process start(const std::vector<std::string>& more = {}) {
    std::vector<std::string> command = {program("edgepose-servo"), "demo", "--seed", "1"};
    if (std::find(more.begin(), more.end(), "-o") == more.end())
      command.insert(command.end(), {"-o", folder / "out"});
    command.insert(command.end(), more.begin(), more.end());
    return Process(command, folder / "log");
  }
  std::string log() const { return read_text(folder / "log"); }
  bool moves() const { return log().find("approaching") != std::string::npos; }
  /// The number behind `label` in the report.
  double reported(const std::string& label) const {
    const std::string report = read_text(folder / "out" / "report.md");
    std::smatch found;
    if (!std::regex_search(report, found, std::regex(label + ": ([0-9.]+)"))) return 1e9;
    return std::stod(found[1]);
  }

  Folder folder;
};

std::vector<pid_t> children_of(pid_t parent) {
  const std::string number = std::to_string(parent);
  std::ifstream file("/proc/" + number + "/task/" + number + "/children");
  std::vector<pid_t> children;
  for (pid_t child; file >> child;) children.push_back(child);
  return children;
}

std::string name_of_process(pid_t process) {
  std::string name = read_text("/proc/" + std::to_string(process) + "/comm");
  return name.substr(0, name.find('\n'));
}

/// The temporary folder that a child's command line names.
std::string private_folder_of(pid_t child) {
  const std::string line = read_text("/proc/" + std::to_string(child) + "/cmdline");
  std::smatch found;
  if (!std::regex_search(line, found, std::regex("/tmp/edgepose-demo-[A-Za-z0-9]{6}")))
    throw std::runtime_error("no temporary folder in " + line);
  return found[0];
}

bool all_gone(const std::vector<pid_t>& processes) {
  return std::all_of(processes.begin(), processes.end(), [](pid_t one) { return kill(one, 0) != 0; });
}

TEST_F(DemoProcess, BringsTheDrillToTheHoleAndReports) {
  Process demo = start();
  ASSERT_EQ(demo.wait(kMostSeconds), 0) << log();
  EXPECT_LT(reported("true tip error at the end"), 1.0);   // [mm]
  EXPECT_LT(reported("true axis error at the end"), 1.0);  // [degrees]
  const std::filesystem::path out = folder / "out";
  for (const char* picture :
       {"start", "end", "camera_path", "feature_errors", "camera_velocities", "true_errors"})
    EXPECT_TRUE(read_text(out / (std::string(picture) + ".png")).starts_with("\x89PNG")) << picture;
  const std::string report = read_text(out / "report.md");
  for (const char* words : {"| approaching |", "|       axial |", "|   converged |", "(end.png)",
                            "landmark 5", "hand-eye (flange_T_camera): translation, mm", "edgeposed 0."})
    EXPECT_THAT(report, HasSubstr(words));
  EXPECT_GT(CsvTable(out / "record" / "arm.csv").rows(), 1000u);
  EXPECT_GT(std::filesystem::file_size(out / "record" / "bus.pcap"), 100'000u);
}

TEST_F(DemoProcess, EndsItsChildrenWhenInterrupted) {
  Process demo = start({"--goal", "calibrations"});
  ASSERT_TRUE(eventually([&] { return moves(); }, kMostSeconds)) << log();
  const std::vector<pid_t> children = children_of(demo.pid());
  ASSERT_EQ(children.size(), 3u);
  demo.signal(SIGINT);
  EXPECT_EQ(demo.wait(30), 1) << log();
  EXPECT_TRUE(all_gone(children));
  EXPECT_THAT(log(), HasSubstr("stopped; nothing is written"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(DemoProcess, EndsItsChildrenWhenKilled) {
  Process demo = start({"--goal", "calibrations"});
  ASSERT_TRUE(eventually([&] { return moves(); }, kMostSeconds)) << log();
  const std::vector<pid_t> children = children_of(demo.pid());
  ASSERT_EQ(children.size(), 3u);
  const std::string used = private_folder_of(children.front());
  demo.signal(SIGKILL);
  // Orphans are reaped by somebody else: dead is enough.
  EXPECT_TRUE(eventually([&] {
    return std::all_of(children.begin(), children.end(), [](pid_t one) {
      const std::string state = read_text("/proc/" + std::to_string(one) + "/stat");
      return state.empty() || state.find(") Z") != std::string::npos;
    });
  }));
  std::filesystem::remove_all(used);  // nobody was left to do it
}

TEST_F(DemoProcess, SaysWhichProgramDied) {
  Process demo = start({"--goal", "calibrations"});
  ASSERT_TRUE(eventually([&] { return moves(); }, kMostSeconds)) << log();
  const std::vector<pid_t> children = children_of(demo.pid());
  for (const pid_t child : children)
    if (name_of_process(child) == "edgepose-sim") kill(child, SIGKILL);
  EXPECT_EQ(demo.wait(30), 2) << log();
  EXPECT_THAT(log(), HasSubstr("edgepose-servo: edgepose-sim ended by signal 9: "));
  EXPECT_TRUE(all_gone(children));
}

TEST_F(DemoProcess, GoesAgainAfterAFaultAndTellsOfIt) {
  Process demo = start({"--goal", "calibrations"});
  ASSERT_TRUE(eventually([&] { return moves(); }, kMostSeconds)) << log();
  for (const pid_t child : children_of(demo.pid())) {
    if (name_of_process(child) != "edgepose-servo") continue;
    kill(child, SIGSTOP);  // for longer than the drives wait
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(child, SIGCONT);
  }
  ASSERT_EQ(demo.wait(kMostSeconds), 0) << log();
  EXPECT_THAT(log(), HasSubstr("reset, and armed again"));
  EXPECT_THAT(log(), HasSubstr("set going again after "));
  EXPECT_THAT(read_text(folder / "out" / "report.md"), HasSubstr("## Faults"));
  EXPECT_GT(reported("true tip error at the end"), 1.0)
      << "[mm] the calibrations are wrong: the report must say so";
}

TEST_F(DemoProcess, RefusesBadInputBeforeAnythingRuns) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"--mesh", "bone.ply"}, "found only --mesh"},
      {{"--target", "nowhere"}, "expected one of the plan's (left_pedicle_screw"},
      {{"--mesh", "/no/bone.ply", "--plan", "/no/plan.json"}, "/no/"},
      {{"-o", "/dev/null/x"}, "/dev/null/x"},
      {{"--goal", "wherever"}, "--goal"}};
  for (const auto& [options, words] : cases) {
    std::filesystem::remove(folder / "log");
    Process demo = start(options);
    EXPECT_EQ(demo.wait(60), 2) << words;
    const std::string said = log();
    EXPECT_TRUE(said.starts_with("edgepose-servo: ")) << said;
    EXPECT_THAT(said, HasSubstr(words));
    EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  }
}

}  // namespace
}  // namespace edgepose::test
