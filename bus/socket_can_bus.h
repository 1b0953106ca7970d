#pragma once
#include <bitset>
#include <string>
#include <vector>

#include "bus/can_bus.h"

namespace edgepose {

struct SocketCanOptions {
  std::vector<uint16_t> ids;             ///< received are these only, each filtered for exactly; empty: all
  int receive_buffer_bytes = 256 << 10;  ///< as far as the system allows
  /// Own frames of these identifiers come back from the controller once they have been on the wire, and are
  /// counted (BusCounters::confirmed, unconfirmed). Costs a system call each; empty: none.
  std::vector<uint16_t> confirm;
};

/// A Linux CAN interface (CAN_RAW). restart-ms is left to the operator, who should leave it off: from bus-off
/// on send() refuses (kDown), until the controller has been restarted or its link been down.
class SocketCanBus : public CanBus {
 public:
  /// Throws InputError if there is no such interface, it is no CAN interface, or it is down.
  explicit SocketCanBus(const std::string& interface, const SocketCanOptions& options = {});
  ~SocketCanBus() override;

  SendResult send(const CanFrame& frame) override;
  /// Frames bear the time at which the kernel received them.
  Received receive(int64_t deadline_ns) override;
  int descriptor() const override { return socket_; }

 private:
  using IdSet = std::bitset<CanFrame::kMaxId + 1>;
  void configure(const std::string& interface, const SocketCanOptions& options);
  void filter(const std::string& interface, const IdSet& ids);
  Received report(BusEvent event);

  int socket_ = -1;
  IdSet received_ids_, confirmed_ids_;
  bool is_off_ = false;     ///< since the last bus-off
  uint32_t overflows_ = 0;  ///< SO_RXQ_OVFL's last count
};

}  // namespace edgepose
