#pragma once
#include <cstddef>
#include <cstdint>

/// A record of an LCM log, as liblcm writes it, all numbers big endian: sync u32, event number i64, time of
/// receipt [us] i64, channel length i32, data length i32, channel, data.
namespace edgepose::lcm_log_format {

inline constexpr uint32_t kSync = 0xeda1da01;
inline constexpr size_t kHeader = 28;
/// Longer ones are taken for damage.
inline constexpr int32_t kMaxChannel = 255, kMaxData = 256 << 20;

}  // namespace edgepose::lcm_log_format
