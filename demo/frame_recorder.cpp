#include "demo/frame_recorder.h"

#include <algorithm>
#include <utility>

#include "messaging/channels.h"
#include "messaging/checked_decode.h"
#include "messaging/transform_message.h"

namespace edgepose {
namespace {

constexpr size_t kMaxWaitingFrames = 30;  // three seconds of them; about 0.3 MB each

}  // namespace

FrameRecorder::FrameRecorder(const UdpmAddress& address, std::string model)
    : model_(std::move(model)), receiver_(address, [this](ReceivedMessage&& message) { take(message); }) {}

void FrameRecorder::take(const ReceivedMessage& message) {
  if (message.channel == channels::kDepth) {
    edgepose_lcm::depth_frame_t frame;
    if (!decode_checked(message.data(), frame).empty()) return;
    const std::scoped_lock lock(mutex_);
    ++frames_;
    waiting_.push_back(std::move(frame));
    if (waiting_.size() > kMaxWaitingFrames) waiting_.pop_front();
  } else if (message.channel == channels::kPoses) {
    edgepose_lcm::pose_estimates_t answer;
    if (decode_checked(message.data(), answer).empty()) take_answer(answer);
  }
}

void FrameRecorder::take_answer(const edgepose_lcm::pose_estimates_t& answer) {
  const std::scoped_lock lock(mutex_);
  ++answers_;
  for (const edgepose_lcm::model_answer_t& one : answer.answers) {
    if (one.model != model_ || one.detections.empty() || one.detections.front().accepted == 0) continue;
    const auto pose = from_message(one.detections.front().camera_T_model);
    if (!pose) continue;
    ++found_;
    const auto frame = std::find_if(waiting_.begin(), waiting_.end(), [&](const auto& waiting) {
      return waiting.sequence == answer.sequence && waiting.capture_utime == answer.capture_utime;
    });
    if (frame == waiting_.end()) continue;
    newest_ = Pair{*frame, *pose, one.detections.front().score};
    if (!first_) first_ = newest_;
  }
}

std::optional<SeenFrame> FrameRecorder::unpacked(const std::optional<Pair>& pair) {
  if (!pair) return std::nullopt;
  SeenFrame seen{{}, pair->camera_T_model, pair->score};
  std::string detail;
  if (unpack(pair->frame, seen.frame, detail) != FrameFault::kNone) return std::nullopt;
  return seen;
}

std::optional<SeenFrame> FrameRecorder::first() const {
  const std::scoped_lock lock(mutex_);
  return unpacked(first_);
}
std::optional<SeenFrame> FrameRecorder::newest() const {
  const std::scoped_lock lock(mutex_);
  return unpacked(newest_);
}
int64_t FrameRecorder::frames() const {
  const std::scoped_lock lock(mutex_);
  return frames_;
}
int64_t FrameRecorder::answers() const {
  const std::scoped_lock lock(mutex_);
  return answers_;
}
int64_t FrameRecorder::found() const {
  const std::scoped_lock lock(mutex_);
  return found_;
}

}  // namespace edgepose
