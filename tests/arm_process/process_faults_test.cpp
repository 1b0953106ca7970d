/// Faults of whole processes: what is asserted is measured from the simulator's truth.
#include <sched.h>
#include <sys/mount.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "messaging/authentication.h"
#include "tests/arm_process/arm_processes.h"
#include "tests/lateness.h"
#include "tests/real_time.h"
#include "tests/worst.h"

namespace edgepose::test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::Le;

bool at_rest(const TruthLine& line) { return line.fastest() < 1e-4; }

class ProcessFaults : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network())
      GTEST_SKIP() << "needs root or user namespaces, and ip (iproute2), for a network of its own";
  }
  /// `trial` once more, if it failed while the machine was so late that a cycle or two were missed: drives
  /// bear 22 ms, and the programs need some of it.
  static void in_real_time(const std::function<void()>& trial) {
    constexpr int64_t kLimit = 10'000'000;  // [ns]
    const auto timed = [&](int64_t& late_ns) {
      const Lateness lateness(late_ns);
      trial();
    };
    const std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    edgepose::in_real_time(name, kLimit, timed, [] {});
  }
  /// As often as is asked for; what `trial` returns is added to the figures.
  static void repeat(const std::vector<Worst*>& figures,
                     const std::function<std::vector<double>(uint64_t seed)>& trial) {
    for (int seed = 1; seed <= process_repetitions() && !HasFailure(); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      std::vector<double> measured;
      in_real_time([&] { measured = trial(static_cast<uint64_t>(seed)); });
      for (size_t k = 0; k < figures.size() && k < measured.size(); ++k) figures[k]->add(measured[k]);
    }
  }
  static void pause(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
};

TEST_F(ProcessFaults, ReachesTheHole) {
  const Folder folder;
  in_real_time([&] {
    ArmProcesses arm(1, {}, {"--config", write_short_way(folder)});
    arm.set_out();
    EXPECT_EQ(arm.await_end(), "converged") << arm.log();
    EXPECT_THAT(
        [&] {
          arm.servo("go", {{"target", "right_pedicle_screw"}});
        },
        testing::ThrowsMessage<std::runtime_error>(HasSubstr("go is refused while converged")));
    arm.controller().signal(SIGTERM);
    EXPECT_EQ(arm.controller().wait(10), 0);
    const auto truth = arm.end_and_read_truth();
    ASSERT_FALSE(truth.empty());
    EXPECT_LT(std::hypot(truth.back().along, truth.back().across), 0.0003);
    double fastest = 0;
    for (const TruthLine& line : truth) fastest = std::max(fastest, line.tip_speed);
    EXPECT_LT(fastest, 0.05);
  });
}

TEST_F(ProcessFaults, KilledWhileMoving) {
  Worst stopped("kill -9 of the controller: drives stop, ms"), rest("... at rest, ms");
  repeat({&stopped, &rest}, [](uint64_t seed) {
    ArmProcesses arm(seed);
    arm.set_out();
    const int64_t killed = steady_now();
    arm.controller().signal(SIGKILL);
    pause(0.6);
    const auto truth = arm.end_and_read_truth();
    const double to_stop = ms_until(truth, killed, [](const TruthLine& line) { return line.stops(); });
    const double to_rest = ms_until(truth, killed, at_rest);
    EXPECT_THAT(to_stop, AllOf(Ge(0), Le(100)));
    EXPECT_THAT(to_rest, AllOf(Ge(0), Le(300)));
    return std::vector{to_stop, to_rest};
  });
}

TEST_F(ProcessFaults, AControllerThatIsStartedAgainCanArm) {
  in_real_time([] {
    ArmProcesses arm(1);
    arm.set_out();
    arm.controller().signal(SIGKILL);
    arm.controller().wait(5);
    arm.start_controller();
    arm.set_out();
  });
}

TEST_F(ProcessFaults, HeldFor200Milliseconds) {
  Worst moved("controller held for 200 ms: urad moved after it went on");
  repeat({&moved}, [](uint64_t seed) {
    ArmProcesses arm(seed);
    arm.set_out();
    arm.controller().signal(SIGSTOP);
    pause(0.2);
    const int64_t resumed = steady_now();
    arm.controller().signal(SIGCONT);
    pause(0.5);
    EXPECT_EQ(arm.state(), "fault");
    const auto truth = arm.end_and_read_truth();
    double most = 0;
    const TruthLine* at = nullptr;
    for (const TruthLine& line : truth) {
      if (line.time_ns < resumed) continue;
      if (at == nullptr) at = &line;
      for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(line.q[i] - at->q[i]));
    }
    EXPECT_NE(at, nullptr);
    EXPECT_LT(most, 1e-5) << "rad moved after it went on";
    return std::vector{1e6 * most};
  });
}

TEST_F(ProcessFaults, PosesEnd) {
  Worst rest("poses end: at rest, ms");
  repeat({&rest}, [](uint64_t seed) {
    ArmProcesses arm(seed);
    arm.set_out();
    const int64_t silent = steady_now();
    arm.sim("poses", {{"wrong", "silent"}});
    pause(1.5);
    EXPECT_EQ(arm.state(), "approaching");
    const auto truth = arm.end_and_read_truth();
    const double to_rest = ms_until(truth, silent, at_rest);
    EXPECT_THAT(to_rest, AllOf(Ge(0), Le(1200)));
    return std::vector{to_rest};
  });
}

TEST_F(ProcessFaults, PoseServiceKilled) {
  Worst rest("kill -9 of edgeposed: at rest, ms");
  in_real_time([&] {
    const Folder state;
    Daemon service(state / "");
    ASSERT_TRUE(service.ready()) << service.log();
    const std::string phantom = EDGEPOSE_SOURCE_DIR "/models/phantom/";
    service.result(
        "models.register",
        {{"name", "phantom"}, {"mesh", phantom + "phantom.ply"}, {"plan", phantom + "drill_plan.json"}});
    ArmProcesses arm(1, {"--publish", "depth"}, {"--model", "phantom"});
    arm.set_out();
    service.process().signal(SIGKILL);
    const int64_t killed = steady_now();
    pause(2);
    EXPECT_EQ(arm.state(), "approaching");
    const auto truth = arm.end_and_read_truth();
    const double to_rest = ms_until(truth, killed, at_rest);
    EXPECT_THAT(to_rest, AllOf(testing::Gt(100), Le(1200))) << "it moved, and came to rest";
    rest.add(to_rest);
  });
}

TEST_F(ProcessFaults, WithAKeyOnlySignedPosesMoveIt) {
  Folder keys;
  SecretKey::random().write(keys / "key");
  const std::string key = keys / "key";
  for (const std::string wrong : {"unsigned", "altered", "replayed"}) {
    SCOPED_TRACE(wrong);
    in_real_time([&] {
      ArmProcesses arm(1, {"--key", key}, {"--key", key});
      arm.sim("poses", {{"wrong", wrong}});
      pause(1.2);  // the frame that shows the hole when go is said must be of the last second
      arm.servo("arm");
      EXPECT_THROW(arm.servo("go", {{"target", kHole}}), std::runtime_error) << "nothing genuine is seen";
      pause(0.3);
      const auto waiting = arm.read_truth();
      for (const TruthLine& line : waiting)
        for (int i = 0; i < 6; ++i) ASSERT_NEAR(line.q[i], waiting.front().q[i], 1e-4) << "rad";
      arm.sim("poses", {{"wrong", "none"}});
      EXPECT_TRUE(eventually([&] { return arm.servo("status")["poses_taken"] >= 3; }));
      arm.servo("go", {{"target", kHole}});
      arm.sim("poses", {{"wrong", wrong}});
      pause(1.2);
      const int64_t rests = steady_now();
      pause(0.5);
      EXPECT_GT(arm.servo("status")["messages"]["messages_" + wrong], 10);
      const auto truth = arm.end_and_read_truth();
      EXPECT_FALSE(truth.empty());
      for (const TruthLine& line : truth) ASSERT_TRUE(line.time_ns <= rests || at_rest(line));
    });
  }
}

TEST_F(ProcessFaults, TheBusIsFlooded) {
  Worst stopped("flood of identifier 1: drives stop, ms");
  repeat({&stopped}, [](uint64_t seed) {
    ArmProcesses arm(seed);
    arm.set_out();
    const int64_t flooded = steady_now();
    arm.sim("flood", {{"seconds", 0.5}});
    pause(0.8);
    EXPECT_EQ(arm.state(), "fault");
    const auto truth = arm.end_and_read_truth();
    const double to_stop = ms_until(truth, flooded, [](const TruthLine& line) { return line.stops(); });
    EXPECT_THAT(to_stop, AllOf(Ge(0), Le(100)));
    return std::vector{to_stop};
  });
}

TEST_F(ProcessFaults, AFullDiskDoesNotMatter) {
  // A disk of 128 KiB, of this process and its children only.
  const Folder folder, configs;
  const std::string disk = folder / "";
  if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
      mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=128k") != 0)
    GTEST_SKIP() << "no file system of its own on this machine: " << std::strerror(errno);
  in_real_time([&] {
    for (const char* name : {"arm.csv", "arm.pcap"}) std::filesystem::remove(disk + name);
    ArmProcesses arm(
        1, {},
        {"--config", write_short_way(configs), "--log", disk + "arm.csv", "--capture", disk + "arm.pcap"});
    arm.set_out();
    EXPECT_EQ(arm.await_end(), "converged") << arm.log();
    EXPECT_THAT(arm.log(), HasSubstr("event=recording_lost"));
    EXPECT_LE(arm.servo("status")["cycles_missed"], 2) << "no cycle waits for the disk";
    arm.controller().signal(SIGTERM);
    EXPECT_EQ(arm.controller().wait(10), 0);
    std::string line;
    for (std::ifstream file(disk + "arm.csv"); std::getline(file, line);)
      ASSERT_EQ(std::count(line.begin(), line.end(), ','), 39) << "a line that is not whole: " << line;
  });
  umount2(disk.c_str(), MNT_DETACH);
}

TEST_F(ProcessFaults, SigtermBringsTheArmToRestFirst) {
  in_real_time([] {
    ArmProcesses arm(2);
    arm.set_out();
    arm.controller().signal(SIGTERM);
    EXPECT_EQ(arm.controller().wait(10), 0);
    const auto truth = arm.end_and_read_truth();
    constexpr int kSwitchOnDisabled = 2;
    ASSERT_GT(truth.size(), 10u);
    EXPECT_TRUE(at_rest(truth.back()));
    for (const int state : truth.back().state) EXPECT_EQ(state, kSwitchOnDisabled);
    // By the controlled stop: the tip slows down within its limits, without the drives' quick stop.
    double most = 0;
    for (size_t i = 10; i < truth.size(); ++i)
      for (int axis = 0; axis < 6; ++axis)
        most = std::max(most, std::abs(truth[i].v[axis] - truth[i - 10].v[axis]) /
                                  (1e-9 * static_cast<double>(truth[i].time_ns - truth[i - 10].time_ns)));
    EXPECT_LT(most, 8.0) << "rad/s^2; the limit is 5, the drives' quick stop is 15";
  });
}

}  // namespace
}  // namespace edgepose::test
