// edgepose-servo and edgepose-sim on the kernel's CAN: the way to the hole, and what befalls the process.
#include <cmath>
#include <csignal>
#include <ctime>

#include "bus/steady_clock.h"
#include "canopen/cob_id.h"
#include "tests/can_vm/arm_in_guest.h"
#include "tests/can_vm/real_time.h"

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
};

TEST_F(ArmProcessFaults, ReachesTheHoleWhileTheClockIsSetByAnHour) {
  Worst along("reaches the hole, the clock set by an hour there and back: tip from the entry, mm");
  Worst slowest("... slowest joint speed in the second about each step, mrad/s");
  Worst refused("... poses refused");
  const auto session = [&] {
    // In the captures folder: what the controller itself records, from its start to its end.
    ArmProcesses& arm = start({"--capture", trace_file("arm_session.pcap")});
    arm.set_out();
    const Lateness late;
    std::vector<int64_t> steps;
    for (const time_t step : {3600, -7200, 3600}) {
      steps.push_back(steady_ns());
      set_clock(step);
      pause(0.3);
    }
    EXPECT_EQ(arm.state(), "approaching");
    pause(0.2);
    const std::vector<TruthLine> truth = arm.read_truth(steps.front());
    double least = 1e9;
    for (const TruthLine& line : truth)
      if (line.time_ns < steps.back() + 300 * kMillisecond) least = std::min(least, line.fastest());
    EXPECT_GT(least, 1e-3) << "rad/s: it goes on moving";
    EXPECT_TRUE(eventually([&] { return arm.state() == "converged"; }, 60)) << arm.log();
    const double refusals = arm.servo("status")["poses_refused"];
    EXPECT_LE(refusals, 3) << "one that was under way at each step";
    arm.controller().signal(SIGTERM);
    EXPECT_EQ(arm.controller().wait(10), 0) << arm.log();
    const std::vector<TruthLine> end = arm.read_truth(steady_ns() - 300 * kMillisecond);
    EXPECT_FALSE(end.empty());
    if (end.empty()) return late.worst_ns();
    const double error = std::hypot(end.back().along, end.back().across);
    EXPECT_LT(error, 0.0003);
    EXPECT_TRUE(is_at_rest(end.back()));
    along.add(1e3 * error), slowest.add(1e3 * least), refused.add(refusals);
    return late.worst_ns();
  };
  in_real_time("session", 5 * kMillisecond, session, [] {});
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
