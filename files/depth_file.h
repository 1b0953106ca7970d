#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// Largest depth image taken, against headers that lie: pixels a side, and in all.
inline constexpr uint32_t kMaxDepthSide = 16384;
inline constexpr uint64_t kMaxDepthPixels = 64'000'000;
/// Depth scales taken, metres per unit: beyond them somebody mixed up units.
inline constexpr double kMinDepthScale = 1e-7, kMaxDepthScale = 0.1;

/// Reads a 16-bit single-channel PNG; 0 = no measurement. `depth_scale` in metres per unit (0.001 if the file
/// holds millimetres). Throws InputError for anything else: another format, 8 bit, colour, truncated or
/// damaged, absurd dimensions (found in the header, before anything is allocated), no measurement at all,
/// for more than `max_pixels`, and for a scale out of range.
DepthImage read_depth_png(const std::filesystem::path& path, double depth_scale,
                          uint64_t max_pixels = kMaxDepthPixels);

/// The same from memory; `name` stands in messages.
DepthImage parse_depth_png(std::span<const std::byte> bytes, const std::string& name, double depth_scale,
                           uint64_t max_pixels = kMaxDepthPixels);

/// A 16-bit PNG in memory, as write_depth_png() writes it; `name` stands in messages.
std::vector<std::byte> encode_depth_png(const DepthImage& image, const std::string& name, double depth_scale);

/// Writes a 16-bit PNG, rounded to the nearest unit of `depth_scale` metres, atomically. Throws InputError if
/// a depth is negative, not finite or too far for 16 bits, or the image is empty.
void write_depth_png(const std::filesystem::path& path, const DepthImage& image, double depth_scale);

}  // namespace edgepose
