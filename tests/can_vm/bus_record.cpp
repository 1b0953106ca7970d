#include "tests/can_vm/bus_record.h"

#include <algorithm>
#include <chrono>
#include <fstream>

#include "bus/pcap_writer.h"
#include "bus/socket_can_bus.h"
#include "bus/steady_clock.h"
#include "canopen/cob_id.h"
#include "canopen/master_options.h"

namespace edgepose::test {
namespace {

std::vector<uint16_t> ids_of_the_arm() {
  const MasterOptions options;
  std::vector<uint16_t> ids = options.received_ids();
  ids.insert(ids.end(), {cob_id::kNmt, cob_id::kSync});
  ids.push_back(static_cast<uint16_t>(cob_id::kHeartbeat + options.master_node));
  for (const int node : options.nodes)
    for (const int function : {cob_id::kRpdo1, cob_id::kSdoRequest})
      ids.push_back(static_cast<uint16_t>(function + node));
  return ids;
}

bool is_set_point(const CanFrame& frame) {
  return (frame.id & 0x780) == cob_id::kRpdo1 && frame.data[0] == 0x0f && frame.data[1] == 0;
}

bool is_of_master(const CanFrame& frame) {
  const int function = frame.id & 0x780;
  const bool is_sync = frame.id == cob_id::kSync, is_heartbeat = function == cob_id::kHeartbeat;
  return frame.id == cob_id::kNmt || is_sync || function == cob_id::kRpdo1 ||
         function == cob_id::kSdoRequest || (is_heartbeat && (frame.id & 0x7f) > 6);
}

}  // namespace

BusRecord::BusRecord(const std::filesystem::path& capture)
    : capture_(capture),
      wall_minus_steady_ns_(wall_minus_steady_ns()),
      bus_(std::make_unique<SocketCanBus>(
          "vcan0",
          SocketCanOptions{.ids = ids_of_the_arm(), .receive_buffer_bytes = 4 << 20, .confirm = {}})),
      thread_([this] { read(); }) {}

BusRecord::~BusRecord() { end(); }

void BusRecord::read() {
  for (bool last = false; !last;) {
    last = ending_;
    for (Received in; (in = bus_->receive(0)).kind != Received::Kind::kNothing;) {
      if (in.kind == Received::Kind::kFrame) frames_.push_back(in.frame);
    }
    if (!last) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void BusRecord::end() {
  ending_ = true;
  if (!thread_.joinable()) return;
  thread_.join();
  PcapWriter writer(capture_, wall_minus_steady_ns_);
  for (const CanFrame& frame : frames_) writer.write(frame);
}

void BusRecord::mark(int64_t time_ns) const {
  const int64_t wall = time_ns + wall_minus_steady_ns_;
  std::filesystem::path file = capture_;
  char text[64];
  std::snprintf(text, sizeof(text), "%lld.%09lld\n", static_cast<long long>(wall / 1'000'000'000),
                static_cast<long long>(wall % 1'000'000'000));
  std::ofstream(file.replace_extension("mark")) << text;
}

template <class Condition>
size_t BusRecord::count_if(int64_t from_ns, int64_t to_ns, const Condition& condition) const {
  return static_cast<size_t>(std::count_if(frames_.begin(), frames_.end(), [&](const CanFrame& frame) {
    return frame.time_ns >= from_ns && frame.time_ns < to_ns && condition(frame);
  }));
}

size_t BusRecord::count(uint16_t function, int64_t from_ns, int64_t to_ns) const {
  return count_if(from_ns, to_ns, [&](const CanFrame& frame) { return (frame.id & 0x780) == function; });
}

size_t BusRecord::count_set_points(int64_t from_ns, int64_t to_ns) const {
  return count_if(from_ns, to_ns, is_set_point);
}

size_t BusRecord::count_of_master(int64_t from_ns, int64_t to_ns) const {
  return count_if(from_ns, to_ns, is_of_master);
}

}  // namespace edgepose::test
