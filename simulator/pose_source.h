#pragma once
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "edgepose_lcm/drill_targets_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "files/drill_plan.h"
#include "matcher/types.h"
#include "messaging/authentication.h"
#include "simulator/random_draws.h"

namespace edgepose {

/// What can be wrong with the messages of a pose service.
enum class PoseWrong : uint8_t {
  kNone,
  kOld,        ///< captured 2 s ago
  kDuplicate,  ///< the content of the last one again, signed anew
  kFuture,     ///< captured in 1 s
  kJump50mm,   ///< along x of the camera
  kTurn20,     ///< degrees, about the model's origin
  kTurn180,
  kNan,             ///< the translation
  kNotOrthonormal,  ///< a quaternion of norm 1.1
  kZeroQuaternion,
  kUnsigned,
  kAltered,   ///< one bit of the pose changed after it was signed
  kReplayed,  ///< a genuine message of before, byte for byte
  kSilent,    ///< none
  kHourStep,  ///< all its clock's stamps an hour later, from now on
  kCount,
};
/// "none", "old", "duplicate", "future", "jump_50mm", "turn_20", "turn_180", "nan", "not_orthonormal",
/// "zero_quaternion", "unsigned", "altered", "replayed", "silent", "hour_step"; nothing for another word.
std::optional<PoseWrong> pose_wrong_named(const std::string& name);
std::string name_of(PoseWrong wrong);
/// All of these names, with commas.
std::string pose_wrong_names();

struct PoseSourceOptions {
  std::string camera = "flange";  ///< name in the messages
  int64_t content_hash = 1;       ///< of the model file that it claims
  double sigma = 0;               ///< [m] of each component of the model's centre: Gaussian noise
  double angle_sigma = 0;         ///< [rad] ... of the rotation vector
  double score = 0.9;             ///< 0 to 1
  uint64_t seed = 1;
  int64_t session = 0;  ///< [us] since 1970, UTC: of the signatures

  std::string check() const;  ///< what is wrong, the field's name first, or nothing
};

/// A message as it is sent.
struct OutgoingMessage {
  std::string channel;
  std::vector<std::byte> bytes;
};

/// Stands in for the pose service in tests without a camera: messages as it would send them, with the true
/// pose or a wrong one. Holds no clock and sends nothing. Not safe for use by several threads at once.
class PoseSource {
 public:
  /// The plan's model is what it claims to have found. With a key, messages are signed. Throws InputError if
  /// an option is wrong.
  PoseSource(const DrillPlan& plan, const std::optional<SecretKey>& key,
             const PoseSourceOptions& options = {});

  /// The answer to one frame: EDGEPOSE_POSES, then EDGEPOSE_DRILL_TARGETS; none if silent. `camera_T_model`:
  /// the truth at the capture. Times [us] since 1970, UTC.
  std::vector<OutgoingMessage> messages(const RigidTransform& camera_T_model, int64_t capture_utime,
                                        int64_t now_utime);

  /// The next `count` answers are wrong; 0: all until told otherwise. kHourStep holds for good, whatever the
  /// count; kDuplicate and kReplayed send nothing as long as nothing has been sent before.
  void set_wrong(PoseWrong wrong, int count = 0);
  PoseWrong wrong() const { return wrong_; }
  int64_t sequence() const { return sequence_; }  ///< of the last answer

 private:
  struct Answer {
    edgepose_lcm::pose_estimates_t poses;
    edgepose_lcm::drill_targets_t targets;
  };
  Answer answer(const RigidTransform& camera_T_model, int64_t capture_utime, int64_t now_utime);
  std::vector<OutgoingMessage> signed_messages(const Answer& answer);
  static void alter(const Answer& answer, std::vector<OutgoingMessage>& sent);

  const DrillPlan plan_;
  const PoseSourceOptions options_;
  std::optional<MessageSigner> signer_;
  RandomDraws draws_;
  PoseWrong wrong_ = PoseWrong::kNone;
  int wrong_left_ = 0;  ///< 0: until told otherwise
  bool hour_later_ = false;
  int64_t sequence_ = 0;
  std::optional<Answer> last_;
  std::deque<std::vector<OutgoingMessage>> genuine_;  ///< the last ones, oldest first
};

}  // namespace edgepose
