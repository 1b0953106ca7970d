#include "settings/toml_keys.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <optional>
#include <sstream>
#include <utility>

#include "common/error.h"
#include "common/nearest_word.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMaxSettingsBytes = 1 << 20;

const std::vector<std::pair<std::string, Verification>> kVerifications = {
    {"free_space", Verification::kFreeSpace},
    {"paper", Verification::kPaper},
    {"surface_overlap", Verification::kSurfaceOverlap}};

std::string where(const std::filesystem::path& file, const toml::source_region& source) {
  return file.string() + ":" + std::to_string(source.begin.line);
}

std::string shown(const toml::node& node) {
  std::ostringstream text;
  if (node.is_table() || node.is_array()) {
    text << "a " << node.type();
  } else {
    node.visit([&](const auto& value) { text << value; });
  }
  return text.str();
}

/// Sets one field from one node; false if the node has another type or lies outside the field's range.
struct Assign {
  const toml::node& node;

  bool operator()(bool* field) const { return set(field, node.value_exact<bool>()); }
  bool operator()(int* field) const { return set_integer(field); }
  bool operator()(uint64_t* field) const { return set_integer(field); }
  bool operator()(float* field) const { return set_number(field); }
  bool operator()(double* field) const { return set_number(field); }
  bool operator()(std::string* field) const { return set(field, node.value_exact<std::string>()); }
  bool operator()(Verification* field) const {
    const auto name = node.value_exact<std::string>();
    for (const auto& [known, value] : kVerifications) {
      if (name == known) {
        *field = value;
        return true;
      }
    }
    return false;
  }

 private:
  template <class T>
  static bool set(T* field, const std::optional<T>& value) {
    if (value) *field = *value;
    return value.has_value();
  }
  template <class T>
  bool set_integer(T* field) const {
    const auto value = node.value_exact<int64_t>();
    if (!value || !std::in_range<T>(*value)) return false;
    *field = static_cast<T>(*value);
    return true;
  }
  template <class T>
  bool set_number(T* field) const {
    const auto value = node.value<double>();  // accepts 1 for 1.0
    if (!value || node.is_boolean() || !std::isfinite(*value)) return false;
    if (std::abs(*value) > static_cast<double>(std::numeric_limits<T>::max())) return false;
    *field = static_cast<T>(*value);
    return true;
  }
};

std::string expected(const SettingKey& key) {
  struct {
    std::string operator()(bool*) const { return "true or false"; }
    std::string operator()(int*) const { return "an integer"; }
    std::string operator()(uint64_t*) const { return "an integer that is not negative"; }
    std::string operator()(float*) const { return "a number"; }
    std::string operator()(double*) const { return "a number"; }
    std::string operator()(std::string*) const { return "text in quotes"; }
    std::string operator()(Verification*) const { return "\"free_space\", \"paper\" or \"surface_overlap\""; }
  } type;
  return key.path + " = " + std::visit(type, key.field);
}

void apply(const toml::table& table, const std::string& prefix, const std::filesystem::path& file,
           const std::vector<SettingKey>& keys) {
  for (const auto& [name, node] : table) {
    const std::string path = prefix + std::string(name.str());
    if (node.is_table()) {
      apply(*node.as_table(), path + ".", file, keys);
      continue;
    }
    const auto key = std::find_if(keys.begin(), keys.end(), [&](const auto& k) { return k.path == path; });
    if (key == keys.end()) {
      std::vector<std::string> known;
      known.reserve(keys.size());
      for (const SettingKey& k : keys) known.push_back(k.path);
      throw InputError::at(where(file, node.source()), "a known key", path,
                           "did you mean " + nearest_word(path, known) + "?");
    }
    if (!std::visit(Assign{node}, key->field)) {
      throw InputError::at(where(file, node.source()), expected(*key), shown(node));
    }
  }
}

}  // namespace

std::string to_toml(const SettingKey& key) {
  return std::visit(
      [](auto* field) {
        std::ostringstream text;
        if constexpr (std::is_same_v<decltype(field), Verification*>) {
          for (const auto& [name, value] : kVerifications) {
            if (value == *field) text << '"' << name << '"';
          }
        } else if constexpr (std::is_same_v<decltype(field), std::string*>) {
          text << std::quoted(*field);
        } else {
          text << std::boolalpha << *field;
        }
        return text.str();
      },
      key.field);
}

void apply_toml(std::string_view text, const std::filesystem::path& file,
                const std::vector<SettingKey>& keys) {
  toml::table table;
  try {
    table = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw InputError::at(where(file, error.source()), "TOML", std::string(error.description()));
  }
  apply(table, "", file, keys);
}

std::string read_settings_text(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool is_empty =
      std::filesystem::is_regular_file(path, ignored) && std::filesystem::is_empty(path, ignored);
  return is_empty ? "" : read_whole_file(path, "a TOML file", kMaxSettingsBytes);
}

}  // namespace edgepose
