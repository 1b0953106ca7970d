#pragma once
#include <filesystem>
#include <vector>

namespace edgepose {

/// Where an output called `path` is to be written: `path` itself, or what it links to. Throws InputError if
/// the name is empty, or something other than a regular file has it (a folder, a device, a pipe, what
/// standard output goes to): such a thing must not be replaced by a file.
std::filesystem::path output_target(const std::filesystem::path& path);

/// Finds out before long work whether `path` can be written at its end: as output_target(), and a file can be
/// made in its folder. Throws InputError too if it is the same file as one of `others`, which are read or
/// written as well; empty names and names of nothing among them do not count.
void check_output(const std::filesystem::path& path, const std::vector<std::filesystem::path>& others = {});

/// The same for a folder that is made when the work is done: it, or the nearest folder above that exists,
/// takes new files.
void check_output_folder(const std::filesystem::path& folder);

}  // namespace edgepose
