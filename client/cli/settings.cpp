#include "client/cli/settings.h"

#include <toml++/toml.h>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>

#include "client/cli/nearest_word.h"
#include "common/error.h"
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

std::vector<SettingKey> setting_keys(Settings& settings) {
  TrainOptions& train = settings.train;
  SceneOptions& scene = settings.scene;
  MatchOptions& match = settings.match;
  PaperOptions& paper = match.paper;
  return {
      {"train.sampling_step", &train.sampling_step},
      {"train.distance_step", &train.distance_step},
      {"train.angle_step_deg", &train.angle_step_deg},
      {"train.min_normal_angle_deg", &train.min_normal_angle_deg},
      {"train.max_normal_angle_deg", &train.max_normal_angle_deg},
      {"train.visibility_filter", &train.visibility_filter},
      {"train.views", &train.views},
      {"train.find_symmetries", &train.find_symmetries},
      {"train.seed", &train.seed},
      {"train.max_table_mb", &train.max_table_mb},
      {"train.threads", &train.threads},
      {"scene.min_depth", &scene.min_depth},
      {"scene.max_depth", &scene.max_depth},
      {"scene.threads", &scene.threads},
      {"match.verification", &match.verification},
      {"match.max_instances", &match.max_instances},
      {"match.accept_score", &match.accept_score},
      {"match.seed", &match.seed},
      {"match.threads", &match.threads},
      {"match.sampling.keep_edges", &match.sampling.keep_edges},
      {"match.sampling.fine_theta_deg", &match.sampling.fine_theta_deg},
      {"match.sampling.theta_factor", &match.sampling.theta_factor},
      {"match.sampling.enough_points", &match.sampling.enough_points},
      {"match.sampling.max_pixel_size", &match.sampling.max_pixel_size},
      {"match.sampling.max_noise", &match.sampling.max_noise},
      {"match.voting.reference_share", &match.voting.reference_share},
      {"match.voting.min_references", &match.voting.min_references},
      {"match.voting.max_references", &match.voting.max_references},
      {"match.voting.peaks_per_reference", &match.voting.peaks_per_reference},
      {"match.voting.border", &match.voting.border},
      {"match.clustering.max_distance", &match.clustering.max_distance},
      {"match.clustering.max_angle_deg", &match.clustering.max_angle_deg},
      {"match.search.batch", &match.search.batch},
      {"match.search.coarse_candidates", &match.search.coarse_candidates},
      {"match.search.fine_candidates", &match.search.fine_candidates},
      {"match.search.sure_once", &match.search.sure_once},
      {"match.search.sure_twice", &match.search.sure_twice},
      {"match.search.sure_thrice", &match.search.sure_thrice},
      {"match.tolerance.surface", &match.tolerance.surface},
      {"match.tolerance.noise_factor", &match.tolerance.noise_factor},
      {"match.tolerance.max_surface", &match.tolerance.max_surface},
      {"match.tolerance.min_normal_cosine", &match.tolerance.min_normal_cosine},
      {"match.tolerance.shallow_depth", &match.tolerance.shallow_depth},
      {"match.refinement.enabled", &match.refinement.enabled},
      {"match.refinement.first_iterations", &match.refinement.first_iterations},
      {"match.refinement.coarse_iterations", &match.refinement.coarse_iterations},
      {"match.refinement.fine_iterations", &match.refinement.fine_iterations},
      {"match.refinement.last_iterations", &match.refinement.last_iterations},
      {"match.refinement.outline_sigma", &match.refinement.outline_sigma},
      {"match.paper.candidates", &paper.candidates},
      {"match.paper.roi_scale", &paper.roi_scale},
      {"match.paper.accept_at_once", &paper.accept_at_once},
      {"match.paper.accept_best", &paper.accept_best},
      {"match.paper.edge_distance", &paper.edge_distance},
      {"match.paper.two_classes", &paper.two_classes},
      {"match.paper.early_exit", &paper.early_exit},
  };
}

std::string to_toml(const SettingKey& key) {
  return std::visit(
      [](auto* field) {
        std::ostringstream text;
        if constexpr (std::is_same_v<decltype(field), Verification*>) {
          for (const auto& [name, value] : kVerifications) {
            if (value == *field) text << '"' << name << '"';
          }
        } else {
          text << std::boolalpha << *field;
        }
        return text.str();
      },
      key.field);
}

Settings read_settings(const std::filesystem::path& path) {
  std::error_code ignored;
  const bool is_empty =
      std::filesystem::is_regular_file(path, ignored) && std::filesystem::is_empty(path, ignored);
  if (is_empty) return {};  // every key is optional
  return parse_settings(read_whole_file(path, "a TOML file", kMaxSettingsBytes), path);
}

Settings parse_settings(std::string_view text, const std::filesystem::path& file) {
  Settings settings;
  toml::table table;
  try {
    table = toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw InputError::at(where(file, error.source()), "TOML", std::string(error.description()));
  }
  apply(table, "", file, setting_keys(settings));
  for (const std::string& fault : {settings.train.check(), settings.scene.check(), settings.match.check()}) {
    if (!fault.empty()) throw InputError(file.string() + ": " + fault);
  }
  return settings;
}

}  // namespace edgepose
