#include "server/service_options.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "common/error.h"
#include "files/number_text.h"

namespace edgepose {
namespace {

struct Range {
  const char* field;
  double value, low, high;
};

std::string first_fault(std::initializer_list<Range> ranges) {
  for (const Range& r : ranges)
    if (!(r.value >= r.low && r.value <= r.high))
      return std::string(r.field) + ": expected " + number_text(r.low) + " to " + number_text(r.high) +
             ", found " + number_text(r.value);
  return "";
}

std::optional<std::string> environment(const char* name) {
  const char* value = std::getenv(name);
  if (value == nullptr || *value == '\0') return std::nullopt;
  return value;
}

}  // namespace

std::string FrameOptions::check() const {
  return first_fault({{"max_age", max_age, 0.001, 1e9},
                      {"max_ahead", max_ahead, 0, 1e9},
                      {"max_cameras", static_cast<double>(max_cameras), 1, 64},
                      {"max_pixels", static_cast<double>(max_pixels), 256, 4096.0 * 4096.0}});
}

std::string TrackingOptions::check() const {
  return first_fault({{"detect_every", static_cast<double>(detect_every), 1, 1e9},
                      {"max_gap", static_cast<double>(max_gap), 0, 1e6},
                      {"margin", static_cast<double>(margin), 0, 10}});
}

std::string TrainingLimits::check() const {
  return first_fault({{"memory_mb", static_cast<double>(memory_mb), 64, 1e6},
                      {"seconds", seconds, 0.1, 86400},
                      {"threads", static_cast<double>(threads), 1, 256}});
}

void ServiceOptions::check(const std::filesystem::path& file) const {
  const auto demand = [&](const std::string& section, const std::string& fault) {
    if (!fault.empty()) throw InputError(file.string() + ": " + section + "." + fault);
  };
  demand("service", first_fault({{"control_port", static_cast<double>(control_port), 0, 65535},
                                 {"http_port", static_cast<double>(http_port), 0, 65535},
                                 {"deadline", deadline, 0, 3600},
                                 {"client_timeout", client_timeout, 0.1, 86400},
                                 {"max_clients", static_cast<double>(max_clients), 1, 1024}}));
  constexpr std::array<const char*, 4> kLevels = {"debug", "info", "warning", "error"};
  if (std::find(kLevels.begin(), kLevels.end(), log_level) == kLevels.end())
    demand("service", "log_level: expected debug, info, warning or error, found '" + log_level + "'");
  demand("frames", frames.check());
  demand("tracking", tracking.check());
  demand("targets", first_fault({{"min_margin", min_margin, 0, 1}}));
  if (matcher.match.verification != Verification::kFreeSpace)
    demand("match",
           "verification: expected free_space, as the others accept a pose in any image, found another");
  demand("training", training.check());
  try {
    parse_udpm_url(lcm_url);
  } catch (const InputError& error) {
    demand("service", std::string("lcm_url: ") + error.what());
  }
  check_settings(matcher, file);
}

std::vector<SettingKey> service_keys(ServiceOptions& options) {
  std::vector<SettingKey> keys = {
      {"service.lcm_url", &options.lcm_url},
      {"service.state_folder", &options.state_folder},
      {"service.control_socket", &options.control_socket},
      {"service.control_port", &options.control_port},
      {"service.http_port", &options.http_port},
      {"service.key_file", &options.key_file},
      {"service.log_level", &options.log_level},
      {"service.deadline", &options.deadline},
      {"service.client_timeout", &options.client_timeout},
      {"service.max_clients", &options.max_clients},
      {"frames.max_age", &options.frames.max_age},
      {"frames.max_ahead", &options.frames.max_ahead},
      {"frames.max_cameras", &options.frames.max_cameras},
      {"frames.max_pixels", &options.frames.max_pixels},
      {"tracking.enabled", &options.tracking.enabled},
      {"tracking.detect_every", &options.tracking.detect_every},
      {"tracking.max_gap", &options.tracking.max_gap},
      {"tracking.margin", &options.tracking.margin},
      {"targets.min_margin", &options.min_margin},
      {"training.memory_mb", &options.training.memory_mb},
      {"training.seconds", &options.training.seconds},
      {"training.threads", &options.training.threads},
  };
  for (SettingKey& key : setting_keys(options.matcher)) keys.push_back(std::move(key));
  return keys;
}

bool is_live(const std::string& key) {
  return key == "service.deadline" || key == "service.log_level" || !key.starts_with("service.");
}

ServiceOptions read_service_options(const std::filesystem::path& path) {
  return parse_service_options(read_settings_text(path), path);
}

ServiceOptions parse_service_options(std::string_view text, const std::filesystem::path& file) {
  ServiceOptions options;
  apply_toml(text, file, service_keys(options));
  options.check(file);
  return options;
}

std::filesystem::path default_state_folder() {
  if (const auto folder = environment("STATE_DIRECTORY")) return *folder;
  if (geteuid() == 0) return "/var/lib/edgepose";
  if (const auto home = environment("XDG_STATE_HOME")) return std::filesystem::path(*home) / "edgepose";
  if (const auto home = environment("HOME")) return std::filesystem::path(*home) / ".local/state/edgepose";
  return std::filesystem::temp_directory_path() / ("edgepose-" + std::to_string(geteuid()));
}

}  // namespace edgepose
