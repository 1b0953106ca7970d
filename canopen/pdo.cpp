#include "canopen/pdo.h"

#include "canopen/cob_id.h"
#include "canopen/little_endian.h"

namespace edgepose {

CanFrame target_frame(int node, const TargetPdo& target, int64_t now_ns) {
  CanFrame frame{
      .id = static_cast<uint16_t>(cob_id::kRpdo1 + node), .size = 7, .data = {}, .time_ns = now_ns};
  write_little_endian(target.controlword, frame.data, 0);
  write_little_endian(target.mode, frame.data, 2);
  write_little_endian(target.position, frame.data, 3);
  return frame;
}

std::optional<StatePdo> decode_state(const CanFrame& frame) {
  if (cob_id::function_of(frame.id) != cob_id::kTpdo1 || frame.size < 7) return std::nullopt;
  return StatePdo{.statusword = read_little_endian<uint16_t>(frame.data, 0),
                  .mode = read_little_endian<int8_t>(frame.data, 2),
                  .position = read_little_endian<int32_t>(frame.data, 3)};
}

std::optional<MotionPdo> decode_motion(const CanFrame& frame) {
  if (cob_id::function_of(frame.id) != cob_id::kTpdo2 || frame.size < 6) return std::nullopt;
  return MotionPdo{.velocity = read_little_endian<int32_t>(frame.data, 0),
                   .torque = read_little_endian<int16_t>(frame.data, 4)};
}

}  // namespace edgepose
