#include "tests/service/peer.h"

namespace edgepose::test {

int64_t utime_now() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

Peer::Peer(const std::string& url)
    : sequence_(utime_now()),
      publisher_(parse_udpm_url(url)),
      receiver_(parse_udpm_url(url), [this](ReceivedMessage&& message) { take(std::move(message)); }) {}

int64_t Peer::send(const DepthFrame& frame, DepthEncoding encoding) {
  DepthFrame now = frame;
  now.sequence = ++sequence_;
  now.capture_utime = utime_now();
  edgepose_lcm::depth_frame_t message = pack(now, 0.0001, encoding);
  message.capture_utime = utime_now();  // the checksum covers the depth only
  const auto bytes = encode(message);
  {
    const std::scoped_lock lock(mutex_);
    sent_[now.sequence] = Clock::now();
  }
  publisher_.publish("EDGEPOSE_DEPTH", bytes);
  return now.sequence;
}

void Peer::send_as_is(const edgepose_lcm::depth_frame_t& message) {
  publisher_.publish("EDGEPOSE_DEPTH", encode(message));
}

void Peer::send_bytes(const std::string& channel, std::span<const std::byte> bytes) {
  publisher_.publish(channel, bytes);
}

std::optional<Peer::Answer> Peer::answer_to(int64_t sequence, double seconds) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                         [&] { return answers_.contains(sequence); }))
    return std::nullopt;
  return answers_.at(sequence);
}

std::optional<edgepose_lcm::drill_targets_t> Peer::targets_of(int64_t sequence, double seconds) {
  std::unique_lock lock(mutex_);
  if (!changed_.wait_for(lock, std::chrono::duration<double>(seconds),
                         [&] { return targets_.contains(sequence); }))
    return std::nullopt;
  return targets_.at(sequence);
}

std::map<int64_t, Peer::Answer> Peer::answers() const {
  const std::scoped_lock lock(mutex_);
  return answers_;
}

Peer::Clock::time_point Peer::sent_at(int64_t sequence) const {
  const std::scoped_lock lock(mutex_);
  return sent_.at(sequence);
}

void Peer::forget() {
  const std::scoped_lock lock(mutex_);
  answers_.clear();
  targets_.clear();
  sent_.clear();
}

void Peer::take(ReceivedMessage&& message) {
  const auto now = Clock::now();
  const std::scoped_lock lock(mutex_);
  if (message.channel == "EDGEPOSE_POSES") {
    Answer answer{{}, {message.data().begin(), message.data().end()}, now};
    if (decode_checked(message.data(), answer.poses).empty())
      answers_[answer.poses.sequence] = std::move(answer);
  } else if (message.channel == "EDGEPOSE_DRILL_TARGETS") {
    edgepose_lcm::drill_targets_t targets;
    if (decode_checked(message.data(), targets).empty()) targets_[targets.sequence] = std::move(targets);
  }
  changed_.notify_all();
}

}  // namespace edgepose::test
