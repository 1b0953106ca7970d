#include "common/atomic_file.h"

#include <algorithm>

#include "common/error.h"
#include "common/output_target.h"

namespace edgepose {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text.data(), text.size()));
}

}  // namespace

void write_file_atomically(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(output_target(path));
  file.write(bytes);
  file.rename_to_target();
}

void write_file_atomically(const std::filesystem::path& path, std::string_view text) {
  write_file_atomically(path, bytes_of(text));
}

FileGroup::~FileGroup() {
  files_.clear();
  std::error_code ignored;  // a folder that somebody else has put something into stays
  std::for_each(new_folders_.rbegin(), new_folders_.rend(),
                [&](const auto& folder) { std::filesystem::remove(folder, ignored); });
}

void FileGroup::make_folder(const std::filesystem::path& folder) {
  std::error_code failure;
  std::vector<std::filesystem::path> missing;
  for (auto above = std::filesystem::absolute(folder); !std::filesystem::exists(above, failure);
       above = above.parent_path()) {
    missing.push_back(above);
    if (!above.has_relative_path()) break;
  }
  std::for_each(missing.rbegin(), missing.rend(), [&](const auto& path) {
    if (std::filesystem::create_directory(path, failure)) new_folders_.push_back(path);
  });
  if (!std::filesystem::is_directory(folder, failure))
    throw InputError::at(folder.string(), "a folder that can be made", "none", "name another");
}

std::filesystem::path FileGroup::add(const std::filesystem::path& path, std::span<const std::byte> bytes) {
  TemporaryFile file(output_target(path));
  file.write(bytes);
  files_.push_back(std::move(file));
  return files_.back().path();
}

std::filesystem::path FileGroup::add(const std::filesystem::path& path, std::string_view text) {
  return add(path, bytes_of(text));
}

void FileGroup::commit() {
  for (TemporaryFile& file : files_) file.rename_to_target();
  files_.clear();
  new_folders_.clear();
}

}  // namespace edgepose
