#pragma once
#include <cstddef>
#include <filesystem>
#include <string>

namespace edgepose {

/// The bytes of a regular file. Throws InputError if it is missing, a folder, a device or pipe, unreadable,
/// empty, or larger than `max_bytes` (nothing is read then). `what` says what was expected: "a drill plan".
std::string read_whole_file(const std::filesystem::path& path, const std::string& what, size_t max_bytes);

}  // namespace edgepose
