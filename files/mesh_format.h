#pragma once
#include <cstddef>
#include <span>
#include <string>

namespace edgepose {

enum class MeshFormat { kUnknown, kPly, kStl, kObj, kPcd };

/// "PLY", "STL", "OBJ", "PCD" or "unknown".
std::string name_of(MeshFormat format);

/// What the first bytes say (for a binary STL: whether its count fits its size). kUnknown if nothing fits,
/// also for files that are cut short.
MeshFormat format_of_content(std::span<const std::byte> bytes);

/// What the extension of a file name says, in any case of letters.
MeshFormat format_of_name(const std::string& name);

bool starts_as_ply(std::span<const std::byte> bytes);
/// "solid" and no control characters near it: some binary STL files start with "solid", too.
bool starts_as_text_stl(std::span<const std::byte> bytes);

/// What a person would call these bytes: "an empty file", "a PNG image", "text that starts with '...'".
std::string describe_content(std::span<const std::byte> bytes);

}  // namespace edgepose
