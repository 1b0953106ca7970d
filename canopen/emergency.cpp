#include "canopen/emergency.h"

#include <algorithm>
#include <cstdio>

#include "canopen/cob_id.h"
#include "canopen/little_endian.h"

namespace edgepose {
namespace {

struct Cause {
  uint16_t code, mask;
  const char* text;
};

/// The exact ones first.
constexpr Cause kCauses[] = {
    {0x0000, 0xffff, "error reset or no error"},
    {0x2310, 0xffff, "continuous over-current"},
    {0x3110, 0xffff, "mains over-voltage"},
    {0x3120, 0xffff, "mains under-voltage"},
    {0x3210, 0xffff, "DC link over-voltage"},
    {0x3220, 0xffff, "DC link under-voltage"},
    {0x4210, 0xffff, "excess temperature of the device"},
    {0x4310, 0xffff, "excess temperature of the drive"},
    {0x7121, 0xffff, "motor blocked"},
    {0x7305, 0xffff, "incremental sensor 1 fault"},
    {0x8110, 0xffff, "CAN overrun"},
    {0x8120, 0xffff, "CAN in error passive mode"},
    {0x8130, 0xffff, "life guard or heartbeat error"},
    {0x8140, 0xffff, "recovered from bus-off"},
    {0x8150, 0xffff, "CAN identifier collision"},
    {0x8210, 0xffff, "PDO not processed: wrong length"},
    {0x8240, 0xffff, "unexpected SYNC length"},
    {0x8250, 0xffff, "RPDO timeout"},
    {0x8400, 0xffff, "velocity controller"},
    {0x8500, 0xffff, "position controller"},
    {0x8611, 0xffff, "following error"},
    {0x8612, 0xffff, "reference limit"},
    {0x8700, 0xffff, "SYNC controller"},
    {0x1000, 0xff00, "generic error"},
    {0x2000, 0xf000, "current"},
    {0x3000, 0xf000, "voltage"},
    {0x4000, 0xf000, "temperature"},
    {0x5000, 0xff00, "device hardware"},
    {0x6000, 0xf000, "device software"},
    {0x7000, 0xff00, "additional modules"},
    {0x8100, 0xff00, "communication"},
    {0x8200, 0xff00, "protocol error"},
    {0x8000, 0xf000, "monitoring"},
    {0x9000, 0xff00, "external error"},
    {0xf000, 0xff00, "additional functions"},
    {0xff00, 0xff00, "device specific"},
};

}  // namespace

CanFrame emergency_frame(int node, const Emergency& emergency, int64_t now_ns) {
  CanFrame frame{
      .id = static_cast<uint16_t>(cob_id::kEmergency + node), .size = 8, .data = {}, .time_ns = now_ns};
  write_little_endian(emergency.code, frame.data, 0);
  frame.data[2] = emergency.error_register;
  std::copy(emergency.manufacturer.begin(), emergency.manufacturer.end(), frame.data.begin() + 3);
  return frame;
}

std::optional<Emergency> decode_emergency(const CanFrame& frame) {
  if (cob_id::function_of(frame.id) != cob_id::kEmergency || cob_id::node_of(frame.id) == 0 ||
      frame.size != 8)
    return std::nullopt;
  Emergency emergency{.code = read_little_endian<uint16_t>(frame.data, 0),
                      .error_register = frame.data[2],
                      .manufacturer = {}};
  std::copy_n(frame.data.begin() + 3, 5, emergency.manufacturer.begin());
  return emergency;
}

const char* cause_of(uint16_t code) {
  for (const Cause& cause : kCauses)
    if ((code & cause.mask) == cause.code) return cause.text;
  return "unknown error";
}

std::string text_of(const Emergency& emergency) {
  char code[8];
  std::snprintf(code, sizeof(code), "0x%04x", unsigned{emergency.code});
  return std::string(code) + " (" + cause_of(emergency.code) + ")";
}

}  // namespace edgepose
