#pragma once
#include <gtest/gtest.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "bus/socket_can_bus.h"
#include "bus/steady_clock.h"
#include "tests/messaging/network_namespace.h"

namespace edgepose {

inline constexpr int64_t kMillisecond = 1'000'000;

/// Captures stay in the folder that can_vm_test.sh gives, for tshark on the host.
inline std::filesystem::path trace_file(const std::string& name) {
  const char* folder = std::getenv("EDGEPOSE_CAN_TRACES");
  return (folder ? std::filesystem::path(folder) : std::filesystem::path(testing::TempDir())) / name;
}

/// True if the command's exit code is 0; what it says is not shown.
inline bool run(const std::string& command) {
  return std::system((command + " >/dev/null 2>&1").c_str()) == 0;
}

/// What others put on vcan0: frames of any kind, past the code under test.
class RawCan {
 public:
  RawCan() : socket_(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan0"));
    const int on = 1;
    EXPECT_EQ(setsockopt(socket_, SOL_CAN_BASE + CAN_RAW, 5 /* CAN_RAW_FD_FRAMES */, &on, sizeof(on)), 0);
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  }
  RawCan(const RawCan&) = delete;
  RawCan& operator=(const RawCan&) = delete;
  ~RawCan() { close(socket_); }

  /// `id` with its flags (CAN_EFF_FLAG, CAN_RTR_FLAG, CAN_ERR_FLAG).
  void put(uint32_t id, std::span<const uint8_t> data) const {
    can_frame frame{};
    frame.can_id = id;
    frame.can_dlc = static_cast<uint8_t>(data.size());
    std::memcpy(frame.data, data.data(), data.size());
    EXPECT_EQ(write(socket_, &frame, sizeof(frame)), static_cast<ssize_t>(sizeof(frame)));
  }
  /// An error frame; `status` is its second byte, which says what became of the controller.
  void put_error(uint32_t error_class, uint8_t status = 0) const {
    const uint8_t data[8] = {0, status, 0, 0, 0, 0, 0, 0};
    put(CAN_ERR_FLAG | error_class, data);
  }
  void put_fd(uint32_t id, uint8_t size) const {
    canfd_frame frame{};
    frame.can_id = id;
    frame.len = size;
    EXPECT_EQ(write(socket_, &frame, sizeof(frame)), static_cast<ssize_t>(sizeof(frame)));
  }

 private:
  int socket_;
};

/// A vcan0 of the test's own, in a network of its own. Skipped where the kernel has no CAN: run_in_vm.sh has.
class Vcan : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network() || !run("ip link add vcan0 type vcan"))
      GTEST_SKIP() << "NOT TESTED: no CAN in this kernel; run it by tests/can_vm/run_in_vm.sh";
    ASSERT_TRUE(run("ip link set vcan0 mtu 72 up"));
    raw.emplace();
  }
  void TearDown() override {
    raw.reset();
    run("ip link del vcan0");
  }
  static CanFrame frame(uint16_t id, uint8_t first = 0, uint8_t size = 8) {
    CanFrame made{.id = id, .size = size, .data = {}, .time_ns = 0};
    made.data[0] = first;
    return made;
  }
  static int64_t soon(int64_t ms = 500) { return steady_ns() + ms * kMillisecond; }

  std::optional<RawCan> raw;
};

}  // namespace edgepose
