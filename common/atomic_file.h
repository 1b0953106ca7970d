#pragma once
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

#include "common/temporary_file.h"

namespace edgepose {

/// Writes `bytes` to a temporary file beside `path` (beside what it links to), flushes it to disk and renames
/// it: readers see the old file or the whole new one, never a part. Throws InputError (path, cause) and
/// leaves nothing behind; also where `path` is a folder, a device or a pipe (common/output_target.h).
void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void write_file_atomically(const std::filesystem::path& path, std::string_view text);

/// Files that belong together: none of them appears before commit(), which only renames.
class FileGroup {
 public:
  FileGroup() = default;
  ~FileGroup();  ///< removes what was not committed, folders made by make_folder() included
  FileGroup(const FileGroup&) = delete;
  FileGroup& operator=(const FileGroup&) = delete;

  /// Makes the folder and those above it, if need be. Throws InputError.
  void make_folder(const std::filesystem::path& folder);
  /// Writes the content; returns where it stands until commit(). Throws InputError.
  std::filesystem::path add(const std::filesystem::path& path, std::span<const std::byte> bytes);
  std::filesystem::path add(const std::filesystem::path& path, std::string_view text);
  /// Puts all files in their places.
  void commit();

 private:
  std::vector<TemporaryFile> files_;
  std::vector<std::filesystem::path> new_folders_;  ///< the outermost first
};

}  // namespace edgepose
