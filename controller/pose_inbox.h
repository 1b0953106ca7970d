#pragma once
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "daemon/counters.h"
#include "edgepose_lcm/drill_targets_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "messaging/authentication.h"
#include "messaging/udpm_assembly.h"
#include "servoing/pose_gate.h"
#include "servoing/servo.h"

namespace edgepose {

/// A planned hole, as the newest answer of the service gives it.
struct SeenTarget {
  ServoGoal hole;           ///< model frame
  bool go = false;          ///< the service's own verdict
  std::string reason;       ///< ... and why not
  double capture_time = 0;  ///< [s] steady clock, of the frame that shows it
};

/// What the pose service says of one model, made into readings for the loop: answer and drill targets of the
/// same frame are paired, and the holes carried into the model's frame. With a key, only messages that the
/// service signed count. Nothing that comes is trusted. Safe from any thread; the loop never waits here.
class PoseInbox {
 public:
  /// `model`: its name in the service. `camera`: only frames of that one; empty: any.
  PoseInbox(std::string model, std::string camera, const std::optional<SecretKey>& key);

  /// A message of any channel, on the receiver's thread. `now_ns` on the steady clock;
  /// `wall_minus_steady_ns`: the wall clock now, which capture times are told on.
  void take(const ReceivedMessage& message, int64_t now_ns, int64_t wall_minus_steady_ns);

  /// The newest reading that has not been taken; nothing if there is none, or another thread is busy here.
  std::optional<PoseReading> take_reading();

  /// The hole of that name, if it is fresh and the service says go. Throws InputError that says what is
  /// wrong: no frames, another name, old, no go.
  SeenTarget find(const std::string& target, double now) const;

  /// From now on a reading counts as accepted only if this hole is in it, where it was, with the service's
  /// go. Without a name: all that the service accepts.
  void follow(const std::string& target, const ServoGoal& hole);

  /// What became of messages, by name.
  const Counters& counters() const { return counters_; }

 private:
  bool is_genuine(const ReceivedMessage& message);
  bool is_clock_steady(int64_t now_ns, int64_t wall_minus_steady_ns);
  void take_poses(const ReceivedMessage& message);
  void take_targets(const ReceivedMessage& message, int64_t wall_minus_steady_ns);
  void pair(const edgepose_lcm::drill_targets_t& targets, int64_t wall_minus_steady_ns);
  bool is_followed_target_sound() const;

  const std::string model_, camera_;
  std::optional<MessageVerifier> verifier_;              // receiver's thread only
  std::optional<edgepose_lcm::pose_estimates_t> poses_;  // likewise: waits for its targets
  std::optional<int64_t> wall_minus_steady_ns_;          // likewise: as of the last message
  int64_t clock_doubted_until_ns_ = 0;                   // likewise
  mutable std::mutex mutex_;
  std::map<std::string, SeenTarget> targets_;  // guarded by mutex_, as all below: of the newest answer
  std::string followed_;
  std::optional<ServoGoal> followed_hole_;
  std::optional<PoseReading> reading_;
  Counters counters_;
};

}  // namespace edgepose
