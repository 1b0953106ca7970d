// Master and drives over the kernel's CAN in real time: a whole session for tshark, and what goes wrong.
#include <algorithm>

#include "canopen/cob_id.h"
#include "tests/can_vm/interface_change.h"
#include "tests/can_vm/live_arm.h"
#include "tests/can_vm/vcan.h"
#include "tests/real_time.h"

namespace edgepose {
namespace {

class ArmOnVcan : public Vcan {
 protected:
  /// A cycle that came 3 ms late or more makes a failure void.
  void in_real_time(const std::string& trace, const std::function<void(LiveArm&)>& session) {
    edgepose::in_real_time(
        trace, 3 * kMillisecond,
        [&](int64_t& late_ns) {
          LiveArm arm(trace_file(trace));
          session(arm);
          late_ns = arm.worst_lateness_ns();
        },
        [this] {
          TearDown();
          SetUp();
        });
  }
  static size_t count(const std::vector<CanFrame>& frames, const std::function<bool(const CanFrame&)>& is) {
    return static_cast<size_t>(std::count_if(frames.begin(), frames.end(), is));
  }
  /// Quick stop, or no power for one that has stopped already.
  static bool is_stop(const CanFrame& f) {
    return f.id >= 0x201 && f.id <= 0x206 && (f.data[0] == 0x02 || f.data[0] == 0) && f.data[1] == 0;
  }
  static bool enables(const CanFrame& f) {
    return f.id >= 0x201 && f.id <= 0x206 && f.data[0] == 0x0f && f.data[1] == 0;
  }
};

TEST_F(ArmOnVcan, ASessionWithAnEmergencyAtItsEnd) {
  in_real_time("session.pcap", [&](LiveArm& arm) {
    ASSERT_NO_FATAL_FAILURE(arm.enable());
    const PerAxis<double> from = arm.positions();
    arm.run_for(2.0, 0.2);
    ASSERT_EQ(arm.master().state().phase, MasterPhase::kEnabled) << arm.master().fault_text();
    arm.run_for(0.2);
    for (size_t i = 0; i < kAxes; ++i) EXPECT_NEAR(arm.positions()[i] - from[i], 0.4, 0.01) << i;
    ASSERT_TRUE(arm.master().disable(steady_ns()));
    ASSERT_TRUE(arm.run_until(MasterPhase::kReady, 2)) << arm.master().fault_text();
    for (const DriveState state : arm.states()) EXPECT_EQ(state, DriveState::kSwitchOnDisabled);
    const BusCounters counters = arm.master_bus().counters();
    EXPECT_EQ(counters.no_room + counters.not_sent + counters.lost + counters.not_decoded + counters.events,
              0u);
    EXPECT_GE(counters.confirmed + 1, arm.master().counters().syncs);
    arm.provoke(2, Provocation::kEmergency);
    ASSERT_TRUE(arm.run_until(MasterPhase::kFault, 1));
    EXPECT_EQ(arm.master().fault().kind, FaultKind::kEmergency);
    EXPECT_EQ(arm.master().fault().node, 3);
    arm.run_for(0.1);
    std::printf("[measured] %zu frames came from the master\n", arm.heard().size());
  });
}

TEST_F(ArmOnVcan, BusOffIsLatchedAndNothingIsSentAfterwards) {
  in_real_time("bus_off.pcap", [&](LiveArm& arm) {
    ASSERT_NO_FATAL_FAILURE(arm.enable());
    arm.run_for(0.3, 0.3);
    ASSERT_EQ(arm.master().state().phase, MasterPhase::kEnabled) << arm.master().fault_text();
    const int64_t off = steady_ns();
    raw->put_error(CAN_ERR_BUSOFF);
    ASSERT_TRUE(arm.run_until(MasterPhase::kFault, 1, 0.3));
    EXPECT_EQ(arm.master().fault().kind, FaultKind::kBusOff) << arm.master().fault_text();
    const int64_t read = steady_ns();
    ASSERT_TRUE(arm.run_until([&] { return arm.rests(); }, 1, 0.3)) << "the drives stop by themselves";
    std::printf("[measured] bus-off: latched after %.1f ms, at rest after %.0f ms\n",
                static_cast<double>(read - off) * 1e-6, static_cast<double>(steady_ns() - off) * 1e-6);
    arm.run_for(0.3, 0.3);
    EXPECT_EQ(count(arm.heard(), [&](const CanFrame& f) { return f.time_ns > read; }), 0u);
    EXPECT_GT(arm.master_bus().counters().not_sent, 50u) << "the master tries to stop the drives";
    EXPECT_EQ(arm.master().fault().kind, FaultKind::kBusOff) << "latched";

    raw->put_error(CAN_ERR_RESTARTED);  // somebody has looked
    arm.run_for(0.1);
    EXPECT_EQ(arm.master().state().phase, MasterPhase::kFault) << "and not before reset";
    ASSERT_TRUE(arm.master().reset(steady_ns()));
    EXPECT_TRUE(arm.run_until(MasterPhase::kReady, 5)) << arm.master().fault_text();
  });
}

TEST_F(ArmOnVcan, AFullQueueForThreeCyclesIsAStop) {
  in_real_time("no_room.pcap", [&](LiveArm& arm) {
    ASSERT_NO_FATAL_FAILURE(arm.enable());
    arm.run_for(0.3, 0.3);
    ASSERT_EQ(arm.master().state().phase, MasterPhase::kEnabled) << arm.master().fault_text();
    InterfaceChange interface;
    interface.slow_down(1000, 32, 64);  // a frame in 16 ms; 4 wait
    ASSERT_TRUE(arm.run_until(MasterPhase::kFault, 2, 0.3));
    const int64_t latched = steady_ns();
    EXPECT_EQ(arm.master().fault().kind, FaultKind::kNoRoom) << arm.master().fault_text();
    EXPECT_EQ(arm.master().fault().found, 3u) << arm.master().fault_text();
    EXPECT_GE(arm.master_bus().counters().no_room, 3u);
    ASSERT_TRUE(arm.run_until([&] { return arm.rests(); }, 1, 0.3)) << "the drives stop by themselves";
    interface.full_speed();
    arm.run_for(0.2, 0.3);
    const auto after = [&](int64_t ns, const auto& is) {
      return count(arm.heard(), [&](const CanFrame& f) { return f.time_ns > latched + ns && is(f); });
    };
    EXPECT_GT(after(0, is_stop), 60u) << "when there is room again";
    // What the queue of 4 frames had taken before may still come.
    EXPECT_EQ(after(5 * 16 * kMillisecond, enables), 0u) << "no set point that was refused is sent later";
  });
}

TEST_F(ArmOnVcan, AQueueThatTakesAllButMovesNotIsAStop) {
  in_real_time("slow.pcap", [&](LiveArm& arm) {
    ASSERT_NO_FATAL_FAILURE(arm.enable());
    arm.run_for(0.3, 0.3);
    ASSERT_EQ(arm.master().state().phase, MasterPhase::kEnabled) << arm.master().fault_text();
    const uint64_t sent = arm.master_bus().counters().sent;
    const int64_t slow = steady_ns();
    InterfaceChange().slow_down(1000, 32, 1 << 16);  // a frame in 16 ms; room for 4096
    ASSERT_TRUE(arm.run_until(MasterPhase::kFault, 2, 0.3));
    std::printf("[measured] slow queue: latched after %.1f ms\n",
                static_cast<double>(steady_ns() - slow) * 1e-6);
    EXPECT_EQ(arm.master().fault().kind, FaultKind::kNoRoom) << arm.master().fault_text();
    EXPECT_EQ(arm.master_bus().counters().no_room, 0u) << "known by SYNCs that were not confirmed only";
    EXPECT_LE(arm.master_bus().counters().sent - sent, 2u * 7 + 10)
        << "two cycles and heartbeats are stale at most";
    EXPECT_TRUE(arm.run_until([&] { return arm.rests(); }, 1, 0.3)) << "the drives stop by themselves";
  });
}

TEST_F(ArmOnVcan, ALinkThatGoesDownInMotionIsAStop) {
  in_real_time("down.pcap", [&](LiveArm& arm) {
    ASSERT_NO_FATAL_FAILURE(arm.enable());
    arm.run_for(0.3, 0.2);
    InterfaceChange().down();
    ASSERT_TRUE(arm.run_until(MasterPhase::kFault, 3, 0.2));
    EXPECT_EQ(arm.master().fault().kind, FaultKind::kBusDown) << arm.master().fault_text();
    EXPECT_TRUE(arm.run_until([&] { return arm.rests(); }, 1, 0.2));
  });
}

}  // namespace
}  // namespace edgepose
