#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace edgepose {

/// A line of the registry: which files make up a model.
struct ManifestEntry {
  std::string name;
  std::string file;       ///< of the trained model, in the state folder
  std::string plan_file;  ///< of the drill plan, or empty
  std::string mesh;       ///< path it was made from
  bool active = true;
  int64_t registered_utime = 0;
};

/// Names of models: 1 to 100 letters, digits, '.', '_', '-', not starting with '.'. Empty if sound, else why
/// not.
std::string name_fault(const std::string& name);

/// registry.json. Throws InputError, led by `name`, for anything that write_manifest() does not write.
std::vector<ManifestEntry> parse_manifest(std::string_view text, const std::string& name);
/// No entries if there is no file.
std::vector<ManifestEntry> read_manifest(const std::filesystem::path& path);
/// Replaces it at once: after a crash there is the old one or the new one.
void write_manifest(const std::filesystem::path& path, const std::vector<ManifestEntry>& entries);

}  // namespace edgepose
