#pragma once
#include <atomic>
#include <filesystem>
#include <memory>
#include <thread>
#include <vector>

#include "bus/can_bus.h"

namespace edgepose::test {

/// What a socket of the test's own hears on vcan0, with the kernel's times: neither the controller nor the
/// simulator has to be believed. Frames of other identifiers than the arm's are not recorded. A thread of its
/// own, after all others, reads what waits.
class BusRecord {
 public:
  /// `capture`: where a pcap is written, when all has been heard: to write there holds up the whole guest.
  explicit BusRecord(const std::filesystem::path& capture);
  BusRecord(const BusRecord&) = delete;
  BusRecord& operator=(const BusRecord&) = delete;
  ~BusRecord();

  /// The moment, as the capture has it [s since 1970], into a file beside it: for who reads the capture.
  void mark(int64_t time_ns) const;
  /// Ends the record.
  void end();
  /// Frames in [from, to) of this function (canopen/cob_id.h) of any drive; after end().
  size_t count(uint16_t function, int64_t from_ns, int64_t to_ns) const;
  /// RPDOs among them that let an axis follow its set point.
  size_t count_set_points(int64_t from_ns, int64_t to_ns) const;
  /// All that is not sent by a drive, among them.
  size_t count_of_master(int64_t from_ns, int64_t to_ns) const;

 private:
  template <class Condition>
  size_t count_if(int64_t from_ns, int64_t to_ns, const Condition& condition) const;
  void read();

  const std::filesystem::path capture_;
  const int64_t wall_minus_steady_ns_;
  std::unique_ptr<CanBus> bus_;
  std::vector<CanFrame> frames_;
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace edgepose::test
