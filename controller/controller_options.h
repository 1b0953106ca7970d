#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "canopen/master_options.h"
#include "daemon/real_time.h"
#include "messaging/udpm_address.h"
#include "servoing/servo.h"
#include "settings/toml_keys.h"

namespace edgepose {

/// Everything that the controller's configuration file sets (config/edgepose-servo.toml).
struct ControllerOptions {
  std::string bus = "can0";              ///< as bus/open_bus.h
  std::string lcm_url = kDefaultLcmUrl;  ///< where the pose service publishes
  std::string model;                     ///< its name in the service: what is followed
  std::string camera;                    ///< only its frames; empty: any
  std::string hand_eye, tool;            ///< files: what the flange is told of camera and tool
  std::string taught;                    ///< file; empty: the goal comes from the two above
  std::string key_file;                  ///< only what is signed with it counts; empty: all does
  std::string control_socket;            ///< empty: default_servo_socket()
  std::string log_level = "info";        ///< debug, info, warning or error
  std::string capture;                   ///< every frame of the bus, as pcap; empty: none
  std::string log;                       ///< a line for every cycle, as CSV; empty: none
  RealTime real_time;                    ///< of the control loop
  bool keep_awake = false;               ///< the processors never sleep (daemon/keep_awake.h)
  uint64_t vendor = DriveIdentity{}.vendor, product = DriveIdentity{}.product;  ///< 1018 of the drives
  ServoOptions servo;
  MasterOptions master;

  /// Throws InputError, led by `file`, that names the field that is wrong or missing.
  void check(const std::filesystem::path& file) const;
};

/// All keys, bound to `options`, which must outlive the result.
std::vector<SettingKey> controller_keys(ControllerOptions& options);

/// The defaults, overridden by the TOML file. Throws InputError as apply_toml(); check() is the caller's.
ControllerOptions read_controller_options(const std::filesystem::path& path);

/// servo.sock, beside the daemon's own socket; $EDGEPOSE_SERVO_SOCKET if that is set.
std::filesystem::path default_servo_socket();

}  // namespace edgepose
