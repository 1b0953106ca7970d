#pragma once
#include <vector>

#include "canopen/master_options.h"
#include "canopen/object_dictionary.h"

namespace edgepose {

/// One thing that is done with a drive before it may be enabled.
struct SetUpStep {
  enum class Kind : uint8_t {
    kBootUp,  ///< NMT reset communication, then boot-up
    kSettle,  ///< nobody else of this number boots
    kExpect,  ///< the object has this value (in the bits of `mask`)
    kWrite,   ///< the object is given this value
    kStart,   ///< NMT start, then a heartbeat that says operational
  };
  Kind kind = Kind::kExpect;
  ObjectId id{};
  ObjectType type = ObjectType::kU32;
  int64_t value = 0;
  const char* name = "";  ///< of the object or its meaning, for messages
  uint32_t mask = 0xffff'ffff;
};

/// The sequence for one axis (CiA 301, 7.3.1 and 7.5.2; CiA 402-2): identity, watchdogs, limits, mode,
/// process data.
std::vector<SetUpStep> set_up_steps(const MasterOptions& options, int axis);

}  // namespace edgepose
