#include "server/manifest.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "common/atomic_file.h"
#include "common/error.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr int kVersion = 1;
constexpr size_t kMaxName = 100, kMaxBytes = 16 << 20;

/// A file of the state folder itself: no path leads out of it.
bool is_plain_name(const std::string& file) {
  return !file.empty() && file.front() != '.' && file.find('/') == std::string::npos &&
         file.find('\0') == std::string::npos;
}

ManifestEntry entry_of(const json& value) {
  ManifestEntry entry;
  entry.name = value.at("name").get<std::string>();
  entry.file = value.at("file").get<std::string>();
  entry.plan_file = value.at("plan_file").get<std::string>();
  entry.mesh = value.at("mesh").get<std::string>();
  entry.active = value.at("active").get<bool>();
  entry.registered_utime = value.at("registered_utime").get<int64_t>();
  return entry;
}

}  // namespace

std::string name_fault(const std::string& name) {
  const auto is_allowed = [](unsigned char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  if (name.empty() || name.size() > kMaxName || name.front() == '.' ||
      !std::all_of(name.begin(), name.end(), is_allowed))
    return "name: expected 1 to 100 letters, digits, '.', '_' or '-', found '" + name.substr(0, kMaxName) +
           "'";
  return "";
}

std::vector<ManifestEntry> parse_manifest(std::string_view text, const std::string& name) {
  std::vector<ManifestEntry> entries;
  try {
    const json whole = json::parse(text);
    if (whole.at("version").get<int>() != kVersion)
      throw InputError::at(name, "version " + std::to_string(kVersion), whole.at("version").dump());
    std::set<std::string> names;
    for (const json& value : whole.at("models")) {
      entries.push_back(entry_of(value));
      const ManifestEntry& entry = entries.back();
      if (const std::string fault = name_fault(entry.name); !fault.empty())
        throw InputError(std::string(name).append(": ").append(fault));
      if (!names.insert(entry.name).second)
        throw InputError::at(name, "each name once", "'" + entry.name + "' twice");
      if (!is_plain_name(entry.file) || (!entry.plan_file.empty() && !is_plain_name(entry.plan_file)))
        throw InputError::at(name, "files of the folder itself", "another path for " + entry.name);
    }
  } catch (const json::exception& error) {
    throw InputError::at(name, "a registry as edgeposed writes it", error.what(),
                         "move it away to start with an empty one");
  }
  return entries;
}

std::vector<ManifestEntry> read_manifest(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return {};
  return parse_manifest(read_whole_file(path, "a registry", kMaxBytes), path.string());
}

void write_manifest(const std::filesystem::path& path, const std::vector<ManifestEntry>& entries) {
  json models = json::array();
  for (const ManifestEntry& e : entries)
    models.push_back({{"name", e.name},
                      {"file", e.file},
                      {"plan_file", e.plan_file},
                      {"mesh", e.mesh},
                      {"active", e.active},
                      {"registered_utime", e.registered_utime}});
  const json whole = {{"version", kVersion}, {"models", models}};
  write_file_atomically(path, whole.dump(1, ' ', false, json::error_handler_t::replace) + "\n");
}

}  // namespace edgepose
