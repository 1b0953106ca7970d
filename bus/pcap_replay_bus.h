#pragma once
#include <filesystem>

#include "bus/can_bus.h"
#include "bus/pcap_reader.h"

namespace edgepose {

/// A recorded bus: its frames come again; what is sent is counted and goes nowhere.
class PcapReplayBus : public CanBus {
 public:
  enum class Pace {
    kRecorded,  ///< each frame as long after the first receive() as it came after the first frame
    kAtOnce,    ///< each as soon as it is asked for, with the time that the file has
  };

  /// Throws InputError as PcapReader does.
  explicit PcapReplayBus(const std::filesystem::path& path, Pace pace = Pace::kRecorded);

  SendResult send(const CanFrame& frame) override;
  /// After the last frame: kEnd once, then nothing.
  Received receive(int64_t deadline_ns) override;

 private:
  PcapReader reader_;
  const Pace pace_;
  Received ahead_;  ///< read, but its time has not come
  bool ended_ = false, begun_ = false;
  int64_t shift_ns_ = 0;  ///< from the file's times to the steady clock
};

}  // namespace edgepose
