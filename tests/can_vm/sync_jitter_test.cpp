// Who should send SYNC: this program, or the kernel's broadcast manager (CAN_BCM)? What the answer in
// docs/canopen.md rests on, measured: the periods of both, and what becomes of each when its owner no longer
// runs.
#include <linux/can/bcm.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <thread>
#include <vector>

#include "tests/can_vm/vcan.h"

namespace edgepose {
namespace {

constexpr int64_t kPeriod = 5 * kMillisecond;

/// The kernel sends a frame with a period by itself, `count` times at most.
class BroadcastManager {
 public:
  BroadcastManager() : socket_(socket(PF_CAN, SOCK_DGRAM | SOCK_CLOEXEC, CAN_BCM)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    EXPECT_EQ(connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  BroadcastManager(const BroadcastManager&) = delete;
  BroadcastManager& operator=(const BroadcastManager&) = delete;
  ~BroadcastManager() { close(socket_); }

  void start(uint32_t count) { set_up(count, SETTIMER | STARTTIMER); }
  /// A new count; the running period is not touched.
  void renew(uint32_t count) { set_up(count, SETTIMER); }

 private:
  void set_up(uint32_t count, uint32_t flags) {
    bcm_msg_head head{};
    head.opcode = TX_SETUP;
    head.flags = flags;
    head.count = count;
    head.ival1.tv_usec = kPeriod / 1000;
    head.can_id = 0x080;
    head.nframes = 1;
    can_frame sync{};
    sync.can_id = 0x080;
    std::array<char, sizeof(head) + sizeof(sync)> message{};
    std::memcpy(message.data(), &head, sizeof(head));
    std::memcpy(message.data() + sizeof(head), &sync, sizeof(sync));
    EXPECT_EQ(write(socket_, message.data(), message.size()), static_cast<ssize_t>(message.size()));
  }
  const int socket_;
};

class SyncJitter : public Vcan {
 protected:
  /// [ns] when each SYNC was on the bus, as the kernel says; until none has come for 50 ms.
  static std::vector<int64_t> times(CanBus& listener) {
    std::vector<int64_t> all;
    for (Received in; (in = listener.receive(soon(50))).kind == Received::Kind::kFrame;)
      all.push_back(in.frame.time_ns);
    return all;
  }
  /// Prints, and returns the mean [ns].
  static double report(const char* who, const std::vector<int64_t>& at) {
    std::vector<double> off;
    for (size_t i = 1; i < at.size(); ++i)
      off.push_back(std::abs(static_cast<double>(at[i] - at[i - 1] - kPeriod)) * 1e-6);
    std::sort(off.begin(), off.end());
    const double mean = static_cast<double>(at.back() - at.front()) / static_cast<double>(at.size() - 1);
    std::printf(
        "[measured] SYNC by %s: %zu, mean period %.4f ms; off by %.3f ms (median), %.3f (p99), %.3f "
        "(worst)\n",
        who, at.size(), mean * 1e-6, off[off.size() / 2], off[off.size() * 99 / 100], off.back());
    return mean;
  }
};

TEST_F(SyncJitter, TheProgramKeepsItsPeriodAndTheBroadcastManagerRunsAway) {
  SocketCanBus listener("vcan0", {.ids = {0x080}, .receive_buffer_bytes = 1 << 20, .confirm = {}});
  constexpr int kCount = 400;
  double own = 0, kernel = 0;
  {
    SocketCanBus bus("vcan0", {.ids = {0x7ff}, .receive_buffer_bytes = 1 << 16, .confirm = {}});
    std::vector<int64_t> at;  // read as they come: the kernel's times are trusted for a second
    std::thread reader([&] { at = times(listener); });
    const sched_param real_time{.sched_priority = 30}, normal{.sched_priority = 0};
    sched_setscheduler(0, SCHED_FIFO, &real_time);
    int64_t next = steady_ns();
    for (int i = 0; i < kCount; ++i, next += kPeriod) {
      wait_for_input(-1, next);
      EXPECT_EQ(bus.send(frame(0x080, 0, 0)), SendResult::kSent);
    }
    sched_setscheduler(0, SCHED_OTHER, &normal);
    reader.join();
    ASSERT_EQ(at.size(), size_t{kCount});
    own = report("the program", at);
  }
  {
    BroadcastManager manager;
    manager.start(kCount);
    const std::vector<int64_t> at = times(listener);
    EXPECT_EQ(at.size(), size_t{kCount}) << "as many as it was told, then it stops by itself";
    kernel = report("the broadcast manager", at);
  }
  EXPECT_NEAR(own, kPeriod, 0.02 * kPeriod);
  // Each period begins where the last one ended, with its delay: no clock is followed.
  EXPECT_GT(kernel, kPeriod);
  std::printf("[measured] in a minute the broadcast manager is %.1f ms behind the program's clock\n",
              60e3 * (kernel / kPeriod - 1));
}

TEST_F(SyncJitter, TheBroadcastManagerGoesOnForAStoppedOwnerUntilItsCountIsUsedUp) {
  SocketCanBus listener("vcan0", {.ids = {0x080}, .receive_buffer_bytes = 1 << 16, .confirm = {}});
  BroadcastManager manager;
  manager.start(3);
  for (int i = 0; i < 20; ++i) {
    usleep(5000);
    manager.renew(3);
  }
  while (listener.receive(0).kind == Received::Kind::kFrame) continue;
  // No set points and no renewal from here on, as of a controller that hangs.
  EXPECT_GE(times(listener).size(), 1u) << "SYNC without set points";
  EXPECT_EQ(listener.receive(soon(50)).kind, Received::Kind::kNothing);
}

}  // namespace
}  // namespace edgepose
