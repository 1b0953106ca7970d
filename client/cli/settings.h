#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "matcher/match.h"
#include "matcher/model.h"
#include "matcher/scene.h"

namespace edgepose {

/// Every option of the matcher, as one configuration file sets them.
struct Settings {
  TrainOptions train;
  SceneOptions scene;
  MatchOptions match;
};

/// One key of the configuration file, bound to the field it sets.
struct SettingKey {
  std::string path;  ///< "match.accept_score"
  std::variant<bool*, int*, uint64_t*, float*, double*, Verification*> field;
};

/// All keys, bound to `settings`, which must outlive the result. The same names as the fields.
std::vector<SettingKey> setting_keys(Settings& settings);

/// The value as it is written in the file: "0.5", "true", "\"free_space\"".
std::string to_toml(const SettingKey& key);

/// The defaults, overridden by the TOML file `path` (every key in config/edgepose.toml).
/// Throws InputError that names the file, the line and the key: syntax, wrong type, out of range, unknown key
/// (with the nearest known one).
Settings read_settings(const std::filesystem::path& path);

/// The same from memory; `file` stands in messages.
Settings parse_settings(std::string_view text, const std::filesystem::path& file);

}  // namespace edgepose
