#include "simulator/simulated_bus.h"

#include <linux/can.h>
#include <linux/can/error.h>
#include <net/if.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "bus/open_bus.h"
#include "bus/steady_clock.h"
#include "bus/unix_address.h"
#include "daemon/log.h"
#include "daemon/real_time.h"

namespace edgepose {
namespace {

constexpr int64_t kMillisecond = 1'000'000;
constexpr const char* kUnix = "unix:";
constexpr int kBusPriority = 61;         // above the drives'
constexpr double kFramesASecond = 8000;  // 1 Mbit/s, frames of 8 bytes

/// Sends one record of 16 bytes on a socket that is closed afterwards.
void send_record(int socket, const sockaddr* address, socklen_t size, bool connects,
                 const std::array<uint8_t, 16>& record) {
  const int joined = socket < 0 ? -1
                     : connects ? connect(socket, address, size)
                                : bind(socket, address, size);
  const bool sent = joined == 0 && write(socket, record.data(), record.size()) == std::ssize(record);
  const int cause = errno;
  if (socket >= 0) close(socket);
  if (!sent) throw InputError::at("bus", "to take an error frame", std::strerror(cause));
}

}  // namespace

SimulatedBus::SimulatedBus(std::string name) : name_(std::move(name)) {
  if (!name_.starts_with(kUnix)) return;
  UnixBusHubOptions options;
  options.rate = kFramesASecond;
  hub_ = std::make_unique<UnixBusHub>(name_.substr(std::strlen(kUnix)), options);
  server_ = std::thread([this] { serve(); });
}

SimulatedBus::~SimulatedBus() {
  ending_ = true;
  const std::scoped_lock lock(mutex_);
  for (std::thread* thread : {&flooder_, &server_})
    if (thread->joinable()) thread->join();
}

void SimulatedBus::serve() {
  become_real_time(kBusPriority);  // where it may: a wire does not wait for programs
  while (!ending_ && up_) {
    hub_->serve(steady_ns() + 20 * kMillisecond);
    members_ = hub_->members();
  }
  if (!up_) hub_.reset();
}

bool SimulatedBus::flood(double seconds) {
  const std::scoped_lock lock(mutex_);
  if (flooding_ || !up_) return false;
  if (flooder_.joinable()) flooder_.join();
  std::shared_ptr<CanBus> bus = open_bus(name_);
  flooding_ = true;
  flooder_ = std::thread([this, bus, end = steady_ns() + static_cast<int64_t>(seconds * 1e9)] {
    // Drives and controller go first: what is tried is the bus, not the processor.
    setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
    CanFrame frame{.id = 1, .size = 8, .data = {}, .time_ns = 0};
    for (int64_t now = steady_ns(); now < end && !ending_ && up_; now = steady_ns()) {
      const SendResult result = bus->send(frame);
      if (result == SendResult::kSent) ++flood_frames_;
      if (result == SendResult::kNoRoom) wait_for_input(-1, now + kMillisecond / 20);
      for (int i = 0; i < 64 && bus->receive(0).kind == Received::Kind::kFrame; ++i) {
      }
    }
    flooding_ = false;
  });
  return true;
}

void SimulatedBus::report_bus_off() {
  std::array<uint8_t, 16> record{};
  uint32_t id = CAN_ERR_FLAG | CAN_ERR_BUSOFF;
  record[4] = CAN_ERR_DLC;
  if (name_.starts_with(kUnix)) {
    for (size_t i = 0; i < 4; ++i) record[i] = static_cast<uint8_t>(id >> (24 - 8 * i));
    const UnixAddress address = unix_address(name_.substr(std::strlen(kUnix)));
    return send_record(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0), address.get(),
                       sizeof(address.value), true, record);
  }
  std::memcpy(record.data(), &id, sizeof(id));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(name_.c_str()));
  send_record(socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW), reinterpret_cast<const sockaddr*>(&address),
              sizeof(address), false, record);
}

bool SimulatedBus::take_down() {
  const std::scoped_lock lock(mutex_);
  if (!server_.joinable()) return !up_;
  up_ = false;
  server_.join();
  members_ = 0;
  return true;
}

}  // namespace edgepose
