#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "messaging/udpm_address.h"
#include "settings/matcher_settings.h"

namespace edgepose {

/// Which frames are looked at.
struct FrameOptions {
  double max_age = 1.0;        ///< [s] frames taken longer ago when they arrive are refused
  double max_ahead = 0.05;     ///< [s] ... and frames that are to be taken in the future by more
  int max_cameras = 8;         ///< cameras at once; one that is silent for ten seconds makes room
  int max_pixels = 4'200'000;  ///< of a frame; larger ones are refused. Memory grows with it

  std::string check() const;
};

/// Following from frame to frame what has been found.
struct TrackingOptions {
  bool enabled = true;
  int detect_every = 150;  ///< [frames] then the whole image is searched even if nothing was lost; one such
                           ///< frame costs a detection's time. Higher: a wrong pose may live longer
  int max_gap = 10;        ///< [frames] after more missing ones the old pose is no start
  float margin = 0.2f;     ///< [d] around the last pose that is looked at; time grows with it

  std::string check() const;
};

/// What a child process that trains may use. A mesh that exceeds it costs only the child.
struct TrainingLimits {
  int memory_mb = 4096;  ///< [MB] of address space
  double seconds = 120;  ///< wall time
  int threads = 1;       ///< it shares the cores with matching, at a low priority

  std::string check() const;
};

/// Everything that the daemon's configuration file sets.
struct ServiceOptions {
  std::string lcm_url = kDefaultLcmUrl;
  std::string state_folder;        ///< models; empty: default_state_folder()
  std::string control_socket;      ///< Unix socket; empty: default_control_socket()
  int control_port = 0;            ///< TCP on 127.0.0.1; 0 = off
  int http_port = 0;               ///< /healthz and /metrics on 127.0.0.1; 0 = off
  std::string key_file;            ///< messages are signed with it; empty: they are not
  std::string log_level = "info";  ///< debug, info, warning or error
  double deadline = 0.5;       ///< [s] after a frame's work began; then what there is is published. 0 = none
  double client_timeout = 60;  ///< [s] a silent client is cut off
  int max_clients = 16;        ///< at once
  FrameOptions frames;
  TrackingOptions tracking;
  TrainingLimits training;
  double min_margin =
      0.1;  ///< [0, 1] targets.min_margin: with less over a clearly different pose, no hole is drilled
  Settings matcher;

  /// Throws InputError, led by `file`, that names the field that is out of range.
  void check(const std::filesystem::path& file) const;
};

/// All keys ("service.lcm_url", "tracking.enabled", "match.accept_score"), bound to `options`.
std::vector<SettingKey> service_keys(ServiceOptions& options);

/// Of these, the ones that take effect when the file is read again (SIGHUP).
bool is_live(const std::string& key);

/// The defaults, overridden by a TOML file (config/edgeposed.toml lists all keys). Throws InputError.
ServiceOptions read_service_options(const std::filesystem::path& path);
ServiceOptions parse_service_options(std::string_view text, const std::filesystem::path& file);

/// systemd's $STATE_DIRECTORY, else /var/lib/edgepose for root, else edgepose in $XDG_STATE_HOME or
/// ~/.local/state.
std::filesystem::path default_state_folder();

}  // namespace edgepose
