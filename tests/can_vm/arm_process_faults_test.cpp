// edgepose-servo and edgepose-sim on the kernel's CAN: the way to the hole, and what befalls the process.
#include <cmath>
#include <csignal>
#include <ctime>
#include <fstream>

#include "bus/steady_clock.h"
#include "canopen/cob_id.h"
#include "tests/can_vm/arm_in_guest.h"
#include "tests/real_time.h"

namespace edgepose::test {
namespace {

class ArmProcessFaults : public ArmInGuest {
 protected:
  /// The guest's clock only: the host's is not its own.
  static void set_clock(time_t step) {
    ASSERT_NE(std::getenv("EDGEPOSE_CAN_VM"), nullptr) << "sets the clock, which only a guest may";
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    now.tv_sec += step;
    ASSERT_EQ(clock_settime(CLOCK_REALTIME, &now), 0);
  }
  /// Sets the clock on the way, and ends the controller when it is there. The tip's distance [mm], the
  /// slowest that the fastest joint was about the steps [mrad/s], poses refused.
  static std::vector<double> approach_and_end(ArmProcesses& arm) {
    std::vector<int64_t> steps;
    // Frames that are under way, of 0.4 s, are left out at each: less than it takes the arm to slow down.
    for (const time_t step : {3600, -7200, 3600}) {
      steps.push_back(steady_ns());
      set_clock(step);
      pause(0.7);
    }
    EXPECT_EQ(arm.state(), "approaching") << arm.log();
    double least = 1e9;
    for (const TruthLine& line : arm.read_truth(steps.front()))
      if (line.time_ns < steps.back() + 500 * kMillisecond) least = std::min(least, line.fastest());
    EXPECT_GT(least, 1e-3) << "rad/s: it goes on moving";
    EXPECT_EQ(arm.await_end(), "converged") << arm.log();
    const double refused = arm.servo("status")["poses_refused"];
    EXPECT_LE(refused, 3) << "one that was under way at each step";
    arm.controller().signal(SIGTERM);
    EXPECT_EQ(arm.controller().wait(10), 0) << arm.log();
    pause(0.2);  // the truth is written
    const std::vector<TruthLine> end = arm.read_truth(steady_ns() - 250 * kMillisecond);
    if (end.empty()) throw std::runtime_error("no truth at the end");
    const double error = std::hypot(end.back().along, end.back().across);
    EXPECT_LT(error, 0.0003);
    EXPECT_TRUE(is_at_rest(end.back()));
    return {1e3 * error, 1e3 * least, refused};
  }
};

TEST_F(ArmProcessFaults, ReachesTheHoleWhileTheClockIsSetByAnHour) {
  Worst along("reaches the hole, the clock set by an hour there and back: tip from the entry, mm");
  Worst refused("... poses refused");
  std::vector<double> figures;
  const auto session = [&](int64_t& late_ns) {
    // Captured by the controller itself, from its start to its end.
    const Folder folder;
    const std::filesystem::path config = folder / "slow.toml";  // under way for longer than the steps take
    std::ofstream(config) << "[approach]\nstandoff = 0.03\nfree_speed = 0.02\n";
    const std::filesystem::path capture = folder / "session.pcap";
    ArmProcesses& arm = moving_anew({"--capture", capture, "--config", config});
    const Lateness lateness(late_ns);
    figures = approach_and_end(arm);
    std::filesystem::copy_file(capture, trace_file("arm_session.pcap"),
                               std::filesystem::copy_options::overwrite_existing);
  };
  for (int i = process_repetitions(1); i > 0 && !HasFailure(); --i) {
    in_real_time("session", kBusy, session, [] {});
    if (HasFailure()) break;
    along.add(figures[0]), refused.add(figures[2]);
    std::printf("[measured] the fastest joint was never slower than %.1f mrad/s about the steps\n",
                figures[1]);
  }
  arm().start_controller({});
}

TEST_F(ArmProcessFaults, KilledWhileMoving) {
  Worst stopped("kill -9 of the controller: drives stop, ms"), rest("... at rest, ms");
  repeat("kill", {&stopped, &rest}, [](ArmProcesses& arm, BusRecord& record) {
    const int64_t killed = steady_ns();
    arm.controller().signal(SIGKILL);
    EXPECT_TRUE(arm.controller().wait(5));
    const int64_t ended = steady_ns();
    pause(0.5);
    record.mark(ended);
    record.end();
    EXPECT_GT(record.count(cob_id::kRpdo1, killed - 50 * kMillisecond, killed), 30u);
    EXPECT_EQ(record.count_of_master(ended, steady_ns()), 0u);
    return expect_stop(arm, killed, 100, 300);
  });
}

TEST_F(ArmProcessFaults, HeldFor200Milliseconds) {
  Worst stopped("controller held for 200 ms: drives stop, ms"), rest("... at rest, ms");
  Worst burst("... RPDOs in the first 50 ms after it went on"), moved("... urad moved since then");
  repeat("held", {&stopped, &rest, &burst, &moved}, [](ArmProcesses& arm, BusRecord& record) {
    const int64_t held = steady_ns();
    arm.controller().signal(SIGSTOP);
    pause(0.2);
    const int64_t resumed = steady_ns();
    arm.controller().signal(SIGCONT);
    pause(0.4);
    EXPECT_EQ(arm.state(), "fault");
    record.end();
    const size_t rpdos = record.count(cob_id::kRpdo1, resumed, resumed + 50 * kMillisecond);
    EXPECT_GT(rpdos, 0u);
    EXPECT_LE(rpdos, 66u) << "six for each of ten cycles, and for one begun";
    EXPECT_EQ(record.count_set_points(resumed, steady_ns()), 0u) << "nothing but stops";
    std::vector<double> figures = expect_stop(arm, held, 100, 300);
    const std::vector<TruthLine> after = arm.read_truth(resumed);
    double most = 0;
    for (const TruthLine& line : after)
      for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(line.q[i] - after.front().q[i]));
    EXPECT_FALSE(after.empty());
    EXPECT_LT(most, 1e-5) << "rad moved after it went on";
    figures.insert(figures.end(), {static_cast<double>(rpdos), 1e6 * most});
    return figures;
  });
}

}  // namespace
}  // namespace edgepose::test
