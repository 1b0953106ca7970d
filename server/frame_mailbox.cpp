#include "server/frame_mailbox.h"

namespace edgepose {
namespace {

constexpr size_t kMaxSlots = 64;  // as many as FrameOptions allows cameras

}  // namespace

bool FrameMailbox::put(DepthFrame&& frame, int64_t receive_utime) {
  const std::scoped_lock lock(mutex_);
  Slot& mine = slot(frame.camera);
  const bool replaced = mine.frame.has_value();
  if (replaced) {
    ++mine.dropped["superseded"];
  } else {
    mine.since = ++arrivals_;
  }
  mine.frame = std::move(frame);
  mine.receive_utime = receive_utime;
  changed_.notify_one();
  return replaced;
}

void FrameMailbox::note_dropped(const std::string& camera, const std::string& cause, int64_t count) {
  const std::scoped_lock lock(mutex_);
  slot(camera).dropped[cause] += count;
}

std::optional<WaitingFrame> FrameMailbox::take() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return woken_ || longest_waiting() != nullptr; });
  Slot* waiting = longest_waiting();
  if (waiting == nullptr) {
    woken_ = false;
    return std::nullopt;
  }
  Slot& next = *waiting;
  WaitingFrame taken{std::move(*next.frame), next.receive_utime, std::move(next.dropped)};
  next.frame.reset();
  next.dropped.clear();
  return taken;
}

void FrameMailbox::wake() {
  const std::scoped_lock lock(mutex_);
  woken_ = true;
  changed_.notify_one();
}

size_t FrameMailbox::cameras() const {
  const std::scoped_lock lock(mutex_);
  return slots_.size();
}

FrameMailbox::Slot* FrameMailbox::longest_waiting() {
  Slot* longest = nullptr;
  for (auto& [camera, each] : slots_)
    if (each.frame && (longest == nullptr || each.since < longest->since)) longest = &each;
  return longest;
}

/// Cameras without a frame that waits make room for others.
FrameMailbox::Slot& FrameMailbox::slot(const std::string& camera) {
  if (slots_.size() >= kMaxSlots && !slots_.contains(camera)) {
    for (auto each = slots_.begin(); each != slots_.end(); ++each) {
      if (each->second.frame) continue;
      slots_.erase(each);
      break;
    }
  }
  return slots_[camera];
}

}  // namespace edgepose
