#include "controller/controller_options.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>

#include "common/error.h"
#include "settings/control_address.h"

namespace edgepose {

void ControllerOptions::check(const std::filesystem::path& file) const {
  const auto fail = [&](const std::string& what) { throw InputError(file.string() + ": " + what); };
  const auto demand = [&](const std::string& value, const std::string& key, const std::string& what) {
    if (value.empty()) fail("controller." + key + ": expected " + what + ", found nothing");
  };
  demand(bus, "bus", "a CAN interface, unix:/path or pcap:/file");
  demand(model, "model", "the name of a model of the pose service");
  demand(hand_eye, "hand_eye", "a file that edgepose calibrate hand-eye has written");
  demand(tool, "tool", "a file that says where the tool is on the flange (docs/servoing.md)");
  constexpr std::array<const char*, 4> kLevels = {"debug", "info", "warning", "error"};
  if (std::find(kLevels.begin(), kLevels.end(), log_level) == kLevels.end())
    fail("controller.log_level: expected debug, info, warning or error, found '" + log_level + "'");
  if (real_time.priority < 0 || real_time.priority > 99)
    fail("controller.rt_priority: expected 0 to 99, found " + std::to_string(real_time.priority));
  if (real_time.processors < 1 || real_time.processors > 64)
    fail("controller.rt_processors: expected 1 to 64, found " + std::to_string(real_time.processors));
  if (vendor > UINT32_MAX || product > UINT32_MAX)
    fail("drives.vendor, drives.product: expected 32 bits, found more");
  if (const std::string fault = servo.check(); !fault.empty()) fail(fault);
  try {
    parse_udpm_url(lcm_url);
    MasterOptions checked = master;
    checked.cycle = servo.motion.cycle;
    checked.check();
  } catch (const InputError& error) {
    fail(std::string("controller.lcm_url: ") + error.what());
  } catch (const std::invalid_argument& error) {
    fail(std::string("drives.") + error.what());
  }
}

std::vector<SettingKey> controller_keys(ControllerOptions& o) {
  ServoOptions& s = o.servo;
  MasterOptions& m = o.master;
  return {{"controller.bus", &o.bus},
          {"controller.lcm_url", &o.lcm_url},
          {"controller.model", &o.model},
          {"controller.camera", &o.camera},
          {"controller.hand_eye", &o.hand_eye},
          {"controller.tool", &o.tool},
          {"controller.taught", &o.taught},
          {"controller.key_file", &o.key_file},
          {"controller.control_socket", &o.control_socket},
          {"controller.log_level", &o.log_level},
          {"controller.capture", &o.capture},
          {"controller.log", &o.log},
          {"controller.rt_priority", &o.real_time.priority},
          {"controller.rt_processors", &o.real_time.processors},
          {"controller.keep_awake", &o.keep_awake},
          {"motion.acceleration", &s.motion.acceleration},
          {"motion.jerk", &s.motion.jerk},
          {"motion.joint_margin", &s.motion.joint_margin},
          {"motion.velocity_share", &s.motion.velocity_share},
          {"approach.standoff", &s.approach.standoff},
          {"approach.free_speed", &s.approach.free_speed},
          {"approach.axial_speed", &s.approach.axial_speed},
          {"approach.max_translation", &s.approach.max_translation},
          {"approach.max_rotation", &s.approach.max_rotation},
          {"approach.distinct_poses", &s.approach.distinct_poses},
          {"gain.at_zero", &s.gain.at_zero},
          {"gain.at_infinity", &s.gain.at_infinity},
          {"gain.slope_at_zero", &s.gain.slope_at_zero},
          {"gate.max_age", &s.gate.max_age},
          {"gate.min_score", &s.gate.min_score},
          {"gate.max_sigma", &s.gate.max_sigma},
          {"gate.max_angle_sigma", &s.gate.max_angle_sigma},
          {"gate.max_jump", &s.gate.max_jump},
          {"gate.max_turn", &s.gate.max_turn},
          {"poses.newest_share", &s.newest_share},
          {"poses.confirming", &s.confirming_poses},
          {"poses.timeout", &s.pose_timeout},
          {"poses.lost_timeout", &s.lost_timeout},
          {"arm.blocked_timeout", &s.blocked_timeout},
          {"arm.goal_timeout", &s.goal_timeout},
          {"arm.max_following", &s.max_following},
          {"drives.vendor", &o.vendor},
          {"drives.product", &o.product},
          {"drives.counts_per_turn", &m.scale.counts_per_turn},
          {"drives.quick_stop_deceleration", &m.quick_stop_deceleration},
          {"drives.following_window", &m.following_window}};
}

ControllerOptions read_controller_options(const std::filesystem::path& path) {
  ControllerOptions options;
  apply_toml(read_settings_text(path), path, controller_keys(options));
  return options;
}

std::filesystem::path default_servo_socket() {
  const char* path = std::getenv("EDGEPOSE_SERVO_SOCKET");
  if (path != nullptr && *path != '\0') return path;
  return default_control_socket().replace_filename("servo.sock");
}

}  // namespace edgepose
