#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "matcher/match_options.h"

namespace edgepose {

/// One key of a configuration file, bound to the field it sets.
struct SettingKey {
  std::string path;  ///< "match.accept_score"
  std::variant<bool*, int*, uint64_t*, float*, double*, std::string*, Verification*> field;
};

/// The value as it is written in the file: "0.5", "true", "\"free_space\"".
std::string to_toml(const SettingKey& key);

/// Sets the fields whose keys stand in `text` (TOML). Throws InputError that names the file, the line and the
/// key: syntax, wrong type, a key that is not in `keys` (with the nearest that is). `file` stands in
/// messages.
void apply_toml(std::string_view text, const std::filesystem::path& file,
                const std::vector<SettingKey>& keys);

/// The content of a configuration file, which may be empty. Throws InputError if it cannot be read.
std::string read_settings_text(const std::filesystem::path& path);

}  // namespace edgepose
