#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/messaging/network_namespace.h"
#include "tests/service/daemon.h"

namespace edgepose::test {

inline constexpr const char* kHole = "left_pedicle_screw";

/// How often each fault is tried with real processes, unless EDGEPOSE_FAULT_REPETITIONS says so (100 is the
/// soak).
int process_repetitions(int otherwise = 3);

/// A line of the simulator's truth.
struct TruthLine {
  int64_t time_ns = 0;
  double q[6], v[6];
  int state[6];
  double along = 0, across = 0, angle = 0, tip_speed = 0;

  double fastest() const;  ///< [rad/s]
  bool stops() const;      ///< no drive is in operation enabled
};

/// edgepose-sim and edgepose-servo as processes, over a bus and LCM, with the simulator's own true poses for
/// a pose service. The network is the test's.
class ArmProcesses {
 public:
  /// `sim`, `servo`: more options. `bus`: a CAN interface; empty: a Unix bus of their own. Starts both and
  /// waits until they serve.
  explicit ArmProcesses(uint64_t seed, std::vector<std::string> sim = {}, std::vector<std::string> servo = {},
                        const std::string& bus = "");

  /// `result` of the controller's answer; throws std::runtime_error with its error.
  nlohmann::json servo(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  nlohmann::json sim(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  std::string state() { return servo("status")["state"]; }
  /// Until it is where it was sent, or in fault: the state then.
  std::string await_end();
  /// Arms and goes, and waits until the arm moves.
  void set_out(const std::string& hole = kHole);

  /// What the simulator has written so far, from this time on; it is at most 0.1 s behind.
  std::vector<TruthLine> read_truth(int64_t from_ns = 0) const;
  /// Ends the simulator and reads all that it has written.
  std::vector<TruthLine> end_and_read_truth();
  Process& controller() { return *controller_; }
  void start_controller();
  /// The same with other options from now on.
  void start_controller(std::vector<std::string> servo);
  std::string log() const { return read_text(folder_ / "servo.log"); }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

 private:
  nlohmann::json call(const std::string& socket, const std::string& method, const nlohmann::json& params);

  Folder folder_;
  const std::string bus_;
  std::vector<std::string> servo_options_;
  std::unique_ptr<Process> simulator_, controller_;
};

/// A configuration file in `folder` with the shortest way at the speed along the axis.
std::filesystem::path write_short_way(const Folder& folder);

/// [ns] on the steady clock.
int64_t steady_now();
/// [ms] from `from_ns` until `holds` stays true up to the end of the record; -1: never.
double ms_until(const std::vector<TruthLine>& truth, int64_t from_ns,
                const std::function<bool(const TruthLine&)>& holds);

}  // namespace edgepose::test
