#pragma once
#include <filesystem>
#include <string_view>
#include <vector>

#include "matcher/match.h"
#include "matcher/model.h"
#include "matcher/scene.h"
#include "settings/toml_keys.h"

namespace edgepose {

/// Every option of the matcher, as one configuration file sets them.
struct Settings {
  TrainOptions train;
  SceneOptions scene;
  MatchOptions match;
};

/// All keys, bound to `settings`, which must outlive the result. The same names as the fields.
std::vector<SettingKey> setting_keys(Settings& settings);

/// Throws InputError, led by `file`, that names the field that is out of range.
void check_settings(const Settings& settings, const std::filesystem::path& file);

/// The defaults, overridden by the TOML file `path` (every key in config/edgepose.toml). Throws InputError
/// that names the file, the line and the key (apply_toml), or the field that is out of range.
Settings read_settings(const std::filesystem::path& path);

/// The same from memory; `file` stands in messages.
Settings parse_settings(std::string_view text, const std::filesystem::path& file);

}  // namespace edgepose
