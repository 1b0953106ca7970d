#pragma once
#include <memory>
#include <vector>

#include "tests/arm_process/arm_processes.h"
#include "tests/can_vm/bus_record.h"
#include "tests/can_vm/interface_change.h"
#include "tests/can_vm/vcan.h"
#include "tests/lateness.h"
#include "tests/worst.h"

namespace edgepose::test {

/// edgepose-sim and edgepose-servo as processes on a vcan0 of the guest. To start both takes it seconds, so
/// that one pair serves many trials, each of which ends with the arm at rest; a new pair starts elsewhere.
class ArmInGuest : public testing::Test {
 protected:
  /// [ns] Drives bear 22 ms, and the programs need some of it in a guest.
  static constexpr int64_t kBusy = 5'000'000;

  static void SetUpTestSuite();
  static void TearDownTestSuite();
  void SetUp() override;

  /// Runs `trial` with an arm on its way as often as is asked for, and adds what it returns to the figures
  /// that it is measured by. Repeated if it failed while the machine was kBusy late or more, or the
  /// drives did not run for so long.
  void repeat(const std::string& name, const std::vector<Worst*>& figures,
              const std::function<std::vector<double>(ArmProcesses&, BusRecord&)>& trial);
  static ArmProcesses& arm() { return *arm_; }
  /// Ends the pair.
  static void end() { arm_.reset(); }
  /// The arm on its way to a hole, with the pair that there is or a new one.
  static ArmProcesses& moving();
  /// With a new pair, from where the way is long.
  static ArmProcesses& moving_anew(std::vector<std::string> servo);
  static void pause(double seconds);

 private:
  static void start();
  static void set_out_again();
  static bool is_moving();

  static inline bool has_can_ = false;
  static inline std::unique_ptr<ArmProcesses> arm_;
  static inline int64_t started_ns_ = 0;
  static inline uint64_t pairs_ = 0, ways_ = 0;
  static inline std::vector<std::string> servo_options_;
};

bool is_at_rest(const TruthLine& line);
/// From the truth, as of `from_ns`: [ms] until no drive follows set points, and until nothing moves. Asserted
/// to be within the limits; the arm must have been moving.
std::vector<double> expect_stop(const ArmProcesses& arm, int64_t from_ns, double stop_within,
                                double rest_within);
/// Until the controller says so; the time [ns] at which it was seen to.
int64_t await_fault(ArmProcesses& arm, const std::string& text);

}  // namespace edgepose::test
