#pragma once
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include "common/error.h"

namespace edgepose {

/// Throws InputError if it is for want of its folder that `file` could not be made; `cause`: errno of that.
inline void refuse_missing_folder(const std::filesystem::path& file, int cause) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code ignored;
  if (cause == ENOENT && !std::filesystem::exists(folder, ignored))
    throw InputError::at(file.string(), "the folder " + folder.string(), "none", "make it first");
}

}  // namespace edgepose
