#pragma once
#include <string>
#include <vector>

#include "canopen/nmt.h"
#include "canopen/sdo_client.h"
#include "canopen/set_up_steps.h"

namespace edgepose {

/// Takes one drive from whatever it was doing to operational, configured and without power. Waits for
/// nothing: who owns it passes in frames and the time. Each step has its own deadline.
class DriveSetUp {
 public:
  enum class State : uint8_t { kIdle, kRunning, kDone, kFailed };

  DriveSetUp(CanBus& bus, const MasterOptions& options, int axis);

  void begin(int64_t now_ns);
  void take(const CanFrame& frame, int64_t now_ns);
  void tick(int64_t now_ns);

  State state() const { return state_; }
  /// If it failed: the node, what was expected, what came, after how long.
  const std::string& error() const { return error_; }
  /// It was reset and has not booted yet.
  bool awaits_boot_up() const { return state_ != State::kIdle && boot_ups_ == 0; }
  /// It has, although nobody sets it up any more.
  void note_boot_up() { ++boot_ups_; }
  /// Two nodes have this number.
  bool found_duplicate() const { return duplicate_; }

 private:
  void enter_step(int64_t now_ns);
  void next_step(int64_t now_ns);
  void take_answer(int64_t now_ns);
  void fail(const std::string& expected, const std::string& found, int64_t now_ns);
  void fail_duplicate(const std::string& found, int64_t now_ns);
  void send_nmt(NmtCommand command, int64_t now_ns);
  const SetUpStep& step() const { return steps_[at_]; }

  CanBus& bus_;
  const MasterOptions& options_;
  const int node_;
  const std::vector<SetUpStep> steps_;
  SdoClient client_;
  State state_ = State::kIdle;
  size_t at_ = 0;
  int64_t began_ns_ = 0;  ///< the step
  int boot_ups_ = 0;
  uint32_t unasked_before_ = 0;
  NmtState last_heartbeat_ = NmtState::kBootUp;
  bool unsent_ = false, duplicate_ = false;
  std::string error_;
};

}  // namespace edgepose
