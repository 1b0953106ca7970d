#pragma once
#include <array>
#include <cstdint>
#include <optional>

#include "bus/can_frame.h"
#include "canopen/objects.h"

namespace edgepose {

/// One entry of a PDO mapping (CiA 301, 7.5.2.36): which object, how many bits of it.
struct MappedObject {
  ObjectId id;
  uint8_t bits = 0;

  /// As in 1600 and 1A00.
  constexpr uint32_t entry() const { return uint32_t{id.index} << 16 | uint32_t{id.sub} << 8 | bits; }
  static constexpr MappedObject from(uint32_t entry) {
    return {.id = {static_cast<uint16_t>(entry >> 16), static_cast<uint8_t>(entry >> 8)},
            .bits = static_cast<uint8_t>(entry)};
  }
};

/// The process data of each axis. The master writes these mappings into the drives; its own codecs, below,
/// follow them (tests/canopen/pdo_test.cpp compares).
inline constexpr std::array<MappedObject, 3> kRpdo1Mapping{
    {{object::kControlword, 16}, {object::kMode, 8}, {object::kTargetPosition, 32}}};
inline constexpr std::array<MappedObject, 3> kTpdo1Mapping{
    {{object::kStatusword, 16}, {object::kModeDisplay, 8}, {object::kPosition, 32}}};
inline constexpr std::array<MappedObject, 2> kTpdo2Mapping{{{object::kVelocity, 32}, {object::kTorque, 16}}};
/// With each SYNC, and with every fourth.
inline constexpr uint8_t kEverySync = 1, kTpdo2Every = 4;

struct TargetPdo {  ///< RPDO1, to the drive
  uint16_t controlword = 0;
  int8_t mode = 0;
  int32_t position = 0;  ///< [counts]
};
struct StatePdo {  ///< TPDO1, from the drive
  uint16_t statusword = 0;
  int8_t mode = 0;
  int32_t position = 0;  ///< [counts]
};
struct MotionPdo {       ///< TPDO2, from the drive
  int32_t velocity = 0;  ///< [counts/s]
  int16_t torque = 0;    ///< [1/1000 of the rated torque]
};

CanFrame target_frame(int node, const TargetPdo& target, int64_t now_ns);
/// None if the frame is another one, or shorter than the mapping (CiA 301, 7.2.2.5: not to be processed).
std::optional<StatePdo> decode_state(const CanFrame& frame);
std::optional<MotionPdo> decode_motion(const CanFrame& frame);

}  // namespace edgepose
