#include "canopen/drive_dictionary.h"

#include "canopen/cia402.h"
#include "canopen/cob_id.h"
#include "canopen/pdo.h"

namespace edgepose {
namespace {

using enum ObjectType;
using enum ObjectAccess;

constexpr uint8_t kMaxMapped = 8;

ObjectEntry count_of(uint16_t index, uint8_t count) {
  return {.id = {index, 0}, .type = kU8, .access = kConst, .value = count};
}

void add_communication(ObjectDictionary& objects, const DriveOptions& options) {
  const DriveIdentity& is = options.identity;
  const auto node = static_cast<uint32_t>(options.node);
  const ObjectEntry entries[] = {
      // 402 in the lower half, 2 (servo drive) in the upper.
      {.id = object::kDeviceType, .type = kU32, .access = kConst, .value = 0x0002'0192},
      {.id = object::kErrorRegister, .type = kU8, .mappable = true},
      {.id = object::kErrorCount, .type = kU8, .access = kReadWrite, .min = 0, .max = 0},
      {.id = object::kSyncCobId, .type = kU32, .access = kReadWrite, .value = cob_id::kSync},
      {.id = object::kCyclePeriod, .type = kU32, .access = kReadWrite, .min = 0, .max = 1'000'000},
      {.id = object::kDeviceName, .type = kText, .access = kConst, .text = options.name},
      {.id = {0x1010, 0}, .type = kU8, .access = kConst, .value = 1},
      {.id = {0x1010, 1}, .type = kU32, .access = kReadOnly},  // 0: saves nothing
      {.id = object::kEmergencyCobId, .type = kU32, .access = kReadOnly, .value = cob_id::kEmergency + node},
      count_of(0x1016, 1),
      {.id = object::kConsumerHeartbeat, .type = kU32, .access = kReadWrite, .min = 0, .max = 0x7f'ffff},
      {.id = object::kProducerHeartbeat, .type = kU16, .access = kReadWrite},
      count_of(0x1018, 4),
      {.id = object::kVendor, .type = kU32, .access = kConst, .value = is.vendor},
      {.id = object::kProduct, .type = kU32, .access = kConst, .value = is.product},
      {.id = object::kRevision, .type = kU32, .access = kConst, .value = is.revision},
      {.id = object::kSerial, .type = kU32, .access = kConst, .value = is.serial},
      count_of(0x1029, 1),
      {.id = object::kErrorBehaviour, .type = kU8, .access = kReadWrite, .value = 1, .min = 0, .max = 2},
      {.id = object::kAxisName, .type = kText, .access = kReadWrite},
  };
  for (const ObjectEntry& entry : entries) objects.add(entry);
  for (uint8_t i = 1; i <= 8; ++i) objects.add({.id = {object::kErrorCount.index, i}, .type = kU32});
}

void add_pdo(ObjectDictionary& objects, uint16_t communication, uint16_t mapping, uint32_t cob) {
  objects.add(count_of(communication, 5));
  objects.add(
      {.id = {communication, 1}, .type = kU32, .access = kReadWrite, .value = cob_id::kNotValid | cob});
  objects.add(
      {.id = {communication, 2}, .type = kU8, .access = kReadWrite, .value = 1, .min = 0, .max = 240});
  objects.add({.id = {communication, 5}, .type = kU16, .access = kReadWrite});
  objects.add({.id = {mapping, 0}, .type = kU8, .access = kReadWrite, .min = 0, .max = kMaxMapped});
  for (uint8_t i = 1; i <= kMaxMapped; ++i)
    objects.add({.id = {mapping, i}, .type = kU32, .access = kReadWrite});
}

void add_drive_profile(ObjectDictionary& objects, const JointScale& scale) {
  const auto counts = [&](double radians) { return int64_t{scale.to_counts(radians)}; };
  const ObjectEntry entries[] = {
      {.id = object::kAbortOption, .type = kI16, .access = kReadWrite, .value = 1, .min = 0, .max = 3},
      {.id = object::kErrorCode, .type = kU16, .mappable = true},
      {.id = object::kControlword, .type = kU16, .access = kReadWrite, .mappable = true},
      {.id = object::kStatusword, .type = kU16, .mappable = true},
      {.id = object::kQuickStopOption, .type = kI16, .access = kReadWrite, .value = 2, .min = 2, .max = 6},
      {.id = object::kHaltOption, .type = kI16, .access = kReadWrite, .value = 1, .min = 1, .max = 1},
      {.id = object::kFaultOption, .type = kI16, .access = kReadWrite, .value = 2, .min = 2, .max = 2},
      {.id = object::kMode, .type = kI8, .access = kReadWrite, .min = 0, .max = 8, .mappable = true},
      {.id = object::kModeDisplay, .type = kI8, .mappable = true},
      {.id = object::kPosition, .type = kI32, .mappable = true},
      {.id = object::kFollowingWindow, .type = kU32, .access = kReadWrite, .value = counts(0.05)},
      {.id = object::kFollowingTimeout, .type = kU16, .access = kReadWrite, .value = 10},
      {.id = object::kVelocity, .type = kI32, .mappable = true},
      {.id = object::kTorque, .type = kI16, .mappable = true},
      {.id = object::kTargetPosition, .type = kI32, .access = kReadWrite, .mappable = true},
      count_of(object::kMinPosition.index, 2),
      {.id = object::kMinPosition, .type = kI32, .access = kReadWrite, .value = counts(-3.14)},
      {.id = object::kMaxPosition, .type = kI32, .access = kReadWrite, .value = counts(3.14)},
      {.id = object::kMaxVelocity, .type = kU32, .access = kReadWrite, .value = counts(3.3), .min = 1},
      {.id = object::kQuickStopDeceleration,
       .type = kU32,
       .access = kReadWrite,
       .value = counts(10),
       .min = 1},
      count_of(object::kInterpolationTime.index, 2),
      {.id = object::kInterpolationTime, .type = kU8, .access = kReadWrite, .value = 1, .min = 1},
      {.id = object::kInterpolationExponent,
       .type = kI8,
       .access = kReadWrite,
       .value = -3,
       .min = -6,
       .max = 0},
      {.id = object::kFollowingError, .type = kI32, .mappable = true},
      {.id = object::kSupportedModes,
       .type = kU32,
       .access = kConst,
       .value = 1 << (kCyclicSynchronousPosition - 1)},
  };
  for (const ObjectEntry& entry : entries) objects.add(entry);
}

/// `count` entries of a mapping as they would be switched on.
SdoAbort check_mapping(const ObjectDictionary& objects, uint16_t mapping, int64_t count) {
  const bool is_written = mapping == object::kRpdoMapping;
  unsigned bits = 0;
  for (int64_t i = 1; i <= count; ++i) {
    const auto mapped =
        MappedObject::from(static_cast<uint32_t>(objects.value({mapping, static_cast<uint8_t>(i)})));
    const ObjectEntry* entry = objects.find(mapped.id);
    if (!entry || !entry->mappable || mapped.bits != 8 * bytes_of(entry->type)) return SdoAbort::kNotMappable;
    if (is_written && entry->access != ObjectAccess::kReadWrite) return SdoAbort::kNotMappable;
    bits += mapped.bits;
  }
  return bits > 64 ? SdoAbort::kPdoTooLong : SdoAbort::kNone;
}

}  // namespace

ObjectDictionary make_drive_dictionary(const DriveOptions& options) {
  ObjectDictionary objects;
  const auto node = static_cast<uint32_t>(options.node);
  add_communication(objects, options);
  add_pdo(objects, object::kRpdoCommunication, object::kRpdoMapping, cob_id::kRpdo1 + node);
  add_pdo(objects, object::kTpdoCommunication, object::kTpdoMapping, cob_id::kTpdo1 + node);
  add_pdo(objects, object::kTpdoCommunication + 1, object::kTpdoMapping + 1, cob_id::kTpdo2 + node);
  add_drive_profile(objects, options.scale);
  return objects;
}

SdoAbort check_pdo_write(const ObjectDictionary& objects, ObjectId id, int64_t value) {
  const bool of_rpdo = id.index == object::kRpdoMapping;
  const bool of_tpdo = id.index == object::kTpdoMapping || id.index == object::kTpdoMapping + 1;
  if (id == object::kMode && value != 0 && value != kCyclicSynchronousPosition)
    return SdoAbort::kInvalidValue;
  if (!of_rpdo && !of_tpdo) return SdoAbort::kNone;
  const auto communication =
      static_cast<uint16_t>(id.index - (object::kRpdoMapping - object::kRpdoCommunication));
  if (!(objects.value({communication, 1}) & cob_id::kNotValid)) return SdoAbort::kDeviceState;
  if (id.sub == 0) return check_mapping(objects, id.index, value);
  return objects.value({id.index, 0}) == 0 ? SdoAbort::kNone : SdoAbort::kDeviceState;
}

}  // namespace edgepose
