// edgepose-servo and edgepose-sim on the kernel's CAN: what befalls the bus while the arm moves.
#include "bus/steady_clock.h"
#include "canopen/cob_id.h"
#include "tests/can_vm/arm_in_guest.h"

namespace edgepose::test {
namespace {

constexpr double kStopWithin = 100, kRestWithin = 300;  // [ms]

class ArmBusFaults : public ArmInGuest {
 protected:
  /// Says that the fault was told once.
  static void expect_told_once(const std::string& log) {
    size_t count = 0;
    for (size_t at = 0; (at = log.find("event=state state=fault", at)) != std::string::npos; ++at) ++count;
    EXPECT_EQ(count, 1u) << log;
  }
  /// A vcan0 does not arbitrate: who comes before all others fills its queue, again before a cycle's seven
  /// frames can have left. Frames sent.
  static uint64_t flood(double seconds) {
    SocketCanBus bus("vcan0", {.ids = {CanFrame::kMaxId}, .receive_buffer_bytes = 1 << 16, .confirm = {}});
    std::thread flooder([&] {
      const sched_param first{.sched_priority = 80};
      pthread_setschedparam(pthread_self(), SCHED_FIFO, &first);
      const int64_t end = steady_ns() + static_cast<int64_t>(seconds * 1e9);
      for (int64_t now = steady_ns(); now < end; now = steady_ns()) {
        while (bus.send({.id = 1, .size = 8, .data = {}, .time_ns = 0}) == SendResult::kSent) continue;
        wait_for_input(-1, now + kMillisecond / 2);
      }
    });
    flooder.join();
    return bus.counters().sent;
  }
  /// What has been logged since `before`, once it is there.
  static std::string new_log(const ArmProcesses& arm, size_t before) { return arm.log().substr(before); }
};

TEST_F(ArmBusFaults, BusOffIsLatched) {
  Worst stopped("bus-off: drives stop, ms"), rest("... at rest, ms"), seen_after("... fault said, ms");
  Worst after("... frames of the controller after that");
  repeat("bus_off", {&stopped, &rest, &seen_after, &after}, [](ArmProcesses& arm, BusRecord& record) {
    const int64_t off = steady_ns();
    arm.sim("bus", {{"off", true}});
    const int64_t seen = await_fault(arm, "bus-off");
    pause(0.4);
    EXPECT_THROW(arm.servo("arm"), std::runtime_error) << "before reset";
    const int64_t quiet_until = steady_ns();
    record.mark(seen);
    record.end();
    const size_t sent = record.count_of_master(seen, quiet_until);
    EXPECT_EQ(sent, 0u);
    BusRecord restarted(trace_file("arm_restarted.pcap"));
    RawCan().put_error(CAN_ERR_RESTARTED);  // somebody has looked
    pause(0.1);
    EXPECT_EQ(arm.state(), "fault") << "latched until reset";
    restarted.end();
    EXPECT_EQ(restarted.count_set_points(0, steady_ns()), 0u) << "nor when it has been restarted";
    std::vector<double> figures = expect_stop(arm, off, kStopWithin, kRestWithin);
    figures.insert(figures.end(), {1e-6 * static_cast<double>(seen - off), static_cast<double>(sent)});
    return figures;
  });
}

TEST_F(ArmBusFaults, AFullQueueIsAStopAndNothingStaleIsSent) {
  Worst stopped("ENOBUFS (a queue of 4 frames, one leaves in 16 ms): drives stop, ms"),
      rest("... at rest, ms");
  Worst stale("... set points after the fault, but for what waited in the queue");
  repeat("no_room", {&stopped, &rest, &stale}, [](ArmProcesses& arm, BusRecord& record) {
    constexpr int64_t kQueue = 5 * 16 * kMillisecond;  // until what waited has left
    InterfaceChange interface;
    const int64_t full = steady_ns();
    interface.slow_down(1000, 32, 64);
    const int64_t seen = await_fault(arm, "no frame was taken for 3 cycles");
    pause(0.3);
    interface.full_speed();
    pause(0.2);
    record.end();
    const size_t late = record.count_set_points(seen + kQueue, steady_ns());
    EXPECT_EQ(late, 0u);
    EXPECT_GT(record.count(cob_id::kRpdo1, seen + kQueue, steady_ns()), 60u) << "stops, as there is room";
    std::vector<double> figures = expect_stop(arm, full, kStopWithin, kRestWithin);
    figures.push_back(static_cast<double>(late));
    return figures;
  });
}

TEST_F(ArmBusFaults, AQueueThatTakesAllButDoesNotMoveIsAStop) {
  Worst stopped("a queue that takes all (one leaves in 16 ms): drives stop, ms"), rest("... at rest, ms");
  Worst seen_after("... fault said, ms");
  repeat("slow", {&stopped, &rest, &seen_after}, [](ArmProcesses& arm, BusRecord&) {
    InterfaceChange interface;
    const int64_t slow = steady_ns();
    interface.slow_down(1000, 32, 1 << 16);  // room for 4096
    const int64_t seen = await_fault(arm, "no frame was taken for 3 cycles");
    pause(0.3);
    interface.full_speed();
    std::vector<double> figures = expect_stop(arm, slow, kStopWithin, kRestWithin);
    figures.push_back(1e-6 * static_cast<double>(seen - slow));
    // The SYNCs that were lost with the queue are not waited for.
    arm.servo("reset");
    arm.servo("arm");
    pause(0.1);
    EXPECT_EQ(arm.state(), "armed") << arm.log();
    return figures;
  });
}

TEST_F(ArmBusFaults, FloodedByFramesOfHighPriority) {
  Worst stopped("flood of identifier 1 (one queue for all, 8000 frames/s, kept full): drives stop, ms");
  Worst rest("... at rest, ms"), frames("... frames of the flood in 0.5 s");
  repeat("flood", {&stopped, &rest, &frames}, [](ArmProcesses& arm, BusRecord&) {
    // A frame has 16 bytes here: as many frames a second as 1 Mbit/s carries.
    InterfaceChange interface;
    interface.slow_down(128'000, 512, 1024);
    pause(0.1);
    EXPECT_EQ(arm.state(), "approaching") << "it works at this rate: " << arm.log();
    const int64_t flooded = steady_ns();
    const double sent = static_cast<double>(flood(0.5));
    pause(0.2);
    interface.full_speed();
    EXPECT_EQ(arm.state(), "fault");
    std::vector<double> figures = expect_stop(arm, flooded, kStopWithin, kRestWithin);
    EXPECT_GT(sent, 2000) << "it has had the bus";
    figures.push_back(sent);
    return figures;
  });
}

TEST_F(ArmBusFaults, TheLinkGoesDown) {
  Worst stopped("link down: drives stop, ms"), rest("... at rest, ms");
  repeat("down", {&stopped, &rest}, [](ArmProcesses& arm, BusRecord&) {
    const size_t logged = arm.log().size();
    const int64_t down = steady_ns();
    InterfaceChange().down();
    await_fault(arm, "bus down");
    pause(0.4);
    std::vector<double> figures = expect_stop(arm, down, kStopWithin, kRestWithin);
    expect_told_once(new_log(arm, logged));
    EXPECT_TRUE(run("ip link set vcan0 up"));
    pause(0.1);
    EXPECT_EQ(arm.state(), "fault") << "a link that is up again is no reason to go on";
    return figures;
  });
}

TEST_F(ArmBusFaults, TheInterfaceIsDeleted) {
  Worst stopped("interface deleted: drives stop, ms"), rest("... at rest, ms");
  repeat("deleted", {&stopped, &rest}, [](ArmProcesses& arm, BusRecord&) {
    const size_t logged = arm.log().size();
    const int64_t deleted = steady_ns();
    InterfaceChange().remove();
    await_fault(arm, "bus down");
    pause(0.4);
    std::vector<double> figures = expect_stop(arm, deleted, kStopWithin, kRestWithin);
    expect_told_once(new_log(arm, logged));
    end();  // who was on it must be started again
    EXPECT_TRUE(run("ip link add vcan0 type vcan") && run("ip link set vcan0 up"));
    return figures;
  });
}

}  // namespace
}  // namespace edgepose::test
