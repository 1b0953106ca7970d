#include "canopen/set_up_steps.h"

#include <cmath>
#include <span>

#include "canopen/cia402.h"
#include "canopen/cob_id.h"
#include "canopen/pdo.h"

namespace edgepose {
namespace {

using enum ObjectType;
using Kind = SetUpStep::Kind;

int64_t milliseconds(double seconds) { return std::lround(seconds * 1e3); }

SetUpStep write(ObjectId id, ObjectType type, int64_t value, const char* name) {
  return {.kind = Kind::kWrite, .id = id, .type = type, .value = value, .name = name};
}

SetUpStep expect(ObjectId id, ObjectType type, int64_t value, const char* name, uint32_t mask = 0xffff'ffff) {
  return {.kind = Kind::kExpect, .id = id, .type = type, .value = value, .name = name, .mask = mask};
}

/// CiA 301, 7.5.2.36: off, count 0, entries, count, then on.
void map_pdo(std::vector<SetUpStep>& steps, uint16_t communication, std::span<const MappedObject> mapping,
             uint32_t cob, uint8_t every) {
  const auto map = static_cast<uint16_t>(communication + (object::kRpdoMapping - object::kRpdoCommunication));
  steps.push_back(write({communication, 1}, kU32, cob_id::kNotValid | cob, "PDO off"));
  steps.push_back(write({map, 0}, kU8, 0, "no mapping"));
  for (size_t i = 0; i < mapping.size(); ++i)
    steps.push_back(write({map, static_cast<uint8_t>(i + 1)}, kU32, mapping[i].entry(), "mapping"));
  steps.push_back(write({map, 0}, kU8, static_cast<int64_t>(mapping.size()), "number of mapped objects"));
  steps.push_back(write({communication, 2}, kU8, every, "transmission type"));
  steps.push_back(write({communication, 1}, kU32, cob, "PDO on"));
}

}  // namespace

std::vector<SetUpStep> set_up_steps(const MasterOptions& options, int axis) {
  const auto i = static_cast<size_t>(axis);
  const auto node = static_cast<uint32_t>(options.nodes[i]);
  const auto counts = [&](double radians) { return int64_t{options.scale.to_counts(radians)}; };
  std::vector<SetUpStep> steps{
      {.kind = Kind::kBootUp},
      {.kind = Kind::kSettle},
      expect(object::kDeviceType, kU32, 402, "device profile", 0xffff),
      expect(object::kVendor, kU32, options.identity.vendor, "vendor"),
      expect(object::kProduct, kU32, options.identity.product, "product"),
  };
  if (options.serials[i] != 0)
    steps.push_back(expect(object::kSerial, kU32, options.serials[i], "serial number"));
  constexpr uint32_t kModeBit = 1 << (kCyclicSynchronousPosition - 1);
  const std::vector<SetUpStep> configuration{
      expect(object::kSupportedModes, kU32, kModeBit, "mode 8 supported", kModeBit),
      write(object::kProducerHeartbeat, kU16, milliseconds(options.drive_heartbeat), "heartbeat"),
      write(object::kConsumerHeartbeat, kU32,
            int64_t{options.master_node} << 16 | milliseconds(options.master_heartbeat_timeout),
            "heartbeat watched"),
      // Whatever ends the connection, the drive comes to rest and holds.
      write(object::kAbortOption, kI16, 3, "quick stop when the connection is lost"),
      write(object::kQuickStopOption, kI16, 6, "quick stop on its ramp, then hold"),
      write(object::kQuickStopDeceleration, kU32, counts(options.quick_stop_deceleration),
            "quick stop deceleration"),
      write(object::kMinPosition, kI32, counts(options.min_position[i]), "lowest position"),
      write(object::kMaxPosition, kI32, counts(options.max_position[i]), "highest position"),
      write(object::kMaxVelocity, kU32, counts(options.max_velocity[i]), "highest velocity"),
      write(object::kFollowingWindow, kU32, counts(options.following_window), "following error window"),
      write(object::kFollowingTimeout, kU16, milliseconds(options.following_timeout),
            "following error timeout"),
      write(object::kSyncCobId, kU32, cob_id::kSync, "SYNC"),
      write(object::kCyclePeriod, kU32, std::lround(options.cycle * 1e6), "SYNC period"),
      write(object::kInterpolationTime, kU8, milliseconds(options.cycle), "interpolation time"),
      write(object::kInterpolationExponent, kI8, -3, "interpolation time's unit"),
      write(object::kMode, kI8, kCyclicSynchronousPosition, "mode"),
  };
  steps.insert(steps.end(), configuration.begin(), configuration.end());
  map_pdo(steps, object::kRpdoCommunication, kRpdo1Mapping, cob_id::kRpdo1 + node, kEverySync);
  steps.push_back(
      write({object::kRpdoCommunication, 5}, kU16, milliseconds(options.rpdo_timeout), "RPDO deadline"));
  map_pdo(steps, object::kTpdoCommunication, kTpdo1Mapping, cob_id::kTpdo1 + node, kEverySync);
  map_pdo(steps, object::kTpdoCommunication + 1, kTpdo2Mapping, cob_id::kTpdo2 + node, kTpdo2Every);
  steps.push_back({.kind = Kind::kStart});
  return steps;
}

}  // namespace edgepose
