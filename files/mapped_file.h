#pragma once
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace edgepose {

/// A file's bytes in memory, read-only, as long as `owner` lives.
struct MappedFile {
  std::span<const std::byte> bytes;
  std::shared_ptr<const void> owner;
};

/// Throws InputError as RegularFile does; `what` says what was expected.
MappedFile map_file(const std::filesystem::path& path, const std::string& what);

}  // namespace edgepose
