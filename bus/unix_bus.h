#pragma once
#include <filesystem>

#include "bus/can_bus.h"

namespace edgepose {

/// A bus without CAN hardware: a connection to a UnixBusHub, which passes each frame on to all others. One
/// record (bus/frame_record.h) a packet (SOCK_SEQPACKET). Arbitration and bit rate are not modelled.
class UnixBus : public CanBus {
 public:
  /// Throws InputError if nobody listens at `path`.
  explicit UnixBus(const std::filesystem::path& path);
  ~UnixBus() override;

  SendResult send(const CanFrame& frame) override;
  /// After the hub has gone: kDown once, then nothing.
  Received receive(int64_t deadline_ns) override;
  int descriptor() const override { return socket_; }

 private:
  int socket_ = -1;
  bool down_ = false;
};

}  // namespace edgepose
