#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace edgepose {

/// Writes `bytes` to a temporary file beside `path`, flushes it to disk and renames it: readers see the old
/// file or the whole new one, never a part. Throws InputError (path, cause) and leaves nothing behind.
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace edgepose
