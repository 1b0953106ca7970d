#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace edgepose {

/// Lossless compression of depth images: runs of zeros, and differences of neighbours in as many groups of 3
/// bits as they need. A. Wilson, "Fast lossless depth image compression", ISS 2017. About 4 times smaller
/// than raw for a time-of-flight image, at some hundred million pixels a second.
std::vector<std::byte> encode_rvl(std::span<const uint16_t> depth);

/// Writes exactly `depth.size()` values. Returns false, with what was written up to there, if `bytes` end too
/// early, go on after the last value, or hold a run or difference that no encoder makes.
bool decode_rvl(std::span<const std::byte> bytes, std::span<uint16_t> depth);

}  // namespace edgepose
