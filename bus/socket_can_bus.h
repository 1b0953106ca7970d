#pragma once
#include <string>
#include <vector>

#include "bus/can_bus.h"

namespace edgepose {

struct SocketCanOptions {
  std::vector<uint16_t> ids;             ///< received are these only, each filtered for exactly; empty: all
  int receive_buffer_bytes = 256 << 10;  ///< as far as the system allows
};

/// A Linux CAN interface (CAN_RAW). restart-ms is left to the operator, who should leave it off: after
/// bus-off nothing is sent until somebody has looked.
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
  void configure(const std::string& interface, const SocketCanOptions& options);

  int socket_ = -1;
  uint32_t overflows_ = 0;  ///< SO_RXQ_OVFL's last count
};

}  // namespace edgepose
