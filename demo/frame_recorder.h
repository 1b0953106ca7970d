#pragma once
#include <deque>
#include <mutex>
#include <optional>
#include <string>

#include "edgepose_lcm/depth_frame_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "matcher/types.h"
#include "messaging/depth_message.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {

/// A depth frame as it was sent, and what the pose service said of it.
struct SeenFrame {
  DepthFrame frame;
  RigidTransform camera_T_model = RigidTransform::Identity();
  double score = 0;
};

/// Listens beside the others: keeps the first and the newest frame in which the service found the model.
class FrameRecorder {
 public:
  /// Throws InputError if the group cannot be joined.
  FrameRecorder(const UdpmAddress& address, std::string model);

  std::optional<SeenFrame> first() const, newest() const;  ///< from any thread
  int64_t frames() const, answers() const, found() const;  ///< that were heard so far

 private:
  struct Pair {
    edgepose_lcm::depth_frame_t frame;
    RigidTransform camera_T_model = RigidTransform::Identity();
    double score = 0;
  };
  void take(const ReceivedMessage& message);
  void take_answer(const edgepose_lcm::pose_estimates_t& answer);
  static std::optional<SeenFrame> unpacked(const std::optional<Pair>& pair);

  const std::string model_;
  mutable std::mutex mutex_;
  std::deque<edgepose_lcm::depth_frame_t> waiting_;  ///< guarded by mutex_, as the next
  std::optional<Pair> first_, newest_;
  int64_t frames_ = 0, answers_ = 0, found_ = 0;
  UdpmReceiver receiver_;  // last: its thread ends first
};

}  // namespace edgepose
