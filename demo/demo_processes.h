#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <stop_token>
#include <string>

#include "common/private_folder.h"
#include "demo/child_program.h"
#include "demo/demo_options.h"

namespace edgepose {

/// The demonstration was asked to stop.
class DemoStopped : public std::runtime_error {
 public:
  DemoStopped() : std::runtime_error("stopped") {}
};

/// Pose service, simulator and controller as child processes that know each other only: a multicast port,
/// sockets and a state folder of their own. All end with this object. Every call throws InputError if one of
/// the programs has ended or does not answer in time, DemoStopped if a stop was asked for. One thread, the
/// main one.
class DemoProcesses {
 public:
  /// Looks at the versions of the three programs. `folder`, which must outlive this, takes all of their
  /// files.
  DemoProcesses(const DemoOptions& options, const PrivateFolder& folder, std::string lcm_url,
                std::stop_token stop);

  void start_service();
  void start_simulator();
  /// `taught`: with taught.json in the folder, else from the calibrations.
  void start_controller(const std::string& model, bool taught);

  nlohmann::json service(const std::string& method, const nlohmann::json& params);
  nlohmann::json simulator(const std::string& method,
                           const nlohmann::json& params = nlohmann::json::object());
  nlohmann::json controller(const std::string& method,
                            const nlohmann::json& params = nlohmann::json::object());

  /// Waits so long; throws early as the calls do.
  void pause(double seconds);
  void check();
  /// Ends the controller first, so that the arm comes to rest under power; then all others.
  void end();
  const std::string& versions() const { return versions_; }  ///< one line

 private:
  struct Part {
    std::string program;
    std::filesystem::path socket;
    std::optional<ChildProgram> child;
  };
  void start(Part& part, const std::vector<std::string>& arguments);
  nlohmann::json call(Part& part, const std::string& method, const nlohmann::json& params);
  std::string version_of(const std::string& program);

  const DemoOptions& options_;
  const PrivateFolder& folder_;
  const std::string lcm_url_;
  const std::stop_token stop_;
  Part service_{"edgeposed", folder_ / "service.sock", {}};
  Part simulator_{"edgepose-sim", folder_ / "sim.sock", {}};
  Part controller_{"edgepose-servo", folder_ / "servo.sock", {}};
  std::string versions_;
};

/// A multicast address on this machine only, with a port that nobody uses now.
std::string private_lcm_url();

}  // namespace edgepose
