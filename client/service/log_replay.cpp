#include "client/service/log_replay.h"

#include <algorithm>

#include "client/service/stop_signals.h"
#include "common/error.h"
#include "messaging/channels.h"
#include "messaging/udpm_packet.h"

namespace edgepose {
namespace {

// A longer silence is a clock that was set, or damage.
constexpr double kLongestGap = 3600;  // [s]

bool is_lcm_channel(const std::string& channel) {
  return !channel.empty() && channel.size() <= kMaxChannelLength &&
         std::all_of(channel.begin(), channel.end(), [](char c) { return c > ' ' && c <= '~'; });
}

bool is_frame_channel(const std::string& channel) {
  return channel == channels::kDepth || channel == channels::kCloud;
}

double seconds_between(int64_t from, int64_t to) {
  return 1e-6 * (static_cast<double>(to) - static_cast<double>(from));
}

}  // namespace

LogReplay::LogReplay(const std::filesystem::path& path, ReplayOptions options, Publish publish,
                     AnswerInbox& inbox)
    : path_(path),
      reader_(path),
      options_(std::move(options)),
      publish_(std::move(publish)),
      inbox_(inbox),
      restamp_(first_sequence()) {}

void LogReplay::run(const std::stop_token& stop) {
  bool any = false;
  for (LoggedMessage message; !stop.stop_requested() && reader_.next(message);) {
    if (!options_.channels.empty() && !options_.channels.contains(message.channel)) {
      ++counters_.other[message.channel];
      continue;
    }
    any = true;
    if (options_.speed > 0 && !wait_for_turn(message.receive_utime, stop)) break;
    send(message, stop);
  }
  counters_.skipped_bytes = reader_.skipped_bytes();
  counters_.cut_off = !stop.stop_requested() && reader_.is_cut_off();
  if (!any && !stop.stop_requested()) fail_without_match();
}

bool LogReplay::wait_for_turn(int64_t utime, const std::stop_token& stop) {
  const double gap = anchor_ ? seconds_between(last_utime_, utime) : 0;
  if (!anchor_ || gap < 0 || gap > kLongestGap) anchor_ = {std::chrono::steady_clock::now(), utime};
  last_utime_ = utime;
  return wait_until(anchor_->at + steady_seconds(seconds_between(anchor_->utime, utime) / options_.speed),
                    stop);
}

void LogReplay::send(LoggedMessage& message, const std::stop_token& stop) {
  const bool on_frame_channel = is_frame_channel(message.channel);
  if (on_frame_channel && !options_.keep_times) {
    const auto outcome = restamp_.restamp(message.channel, utime_now(), message.data);
    counters_.malformed += outcome == FrameRestamp::Outcome::kMalformed;
    counters_.beyond += outcome == FrameRestamp::Outcome::kBeyond;
    if (outcome != FrameRestamp::Outcome::kDone) return;
  }
  std::string camera;
  int64_t sequence = 0;
  const bool is_frame = on_frame_channel && frame_identity(message.channel, message.data, camera, sequence);
  if (is_frame) inbox_.expect(camera, sequence);
  if (!is_lcm_channel(message.channel) || !publish_(message.channel, message.data)) {
    ++counters_.refused;
    return;
  }
  ++counters_.sent;
  counters_.frames += is_frame;
  if (!is_frame || options_.speed > 0) return;
  const auto latency = inbox_.wait(stop, std::chrono::steady_clock::now() + steady_seconds(options_.timeout));
  if (!latency) return;
  ++counters_.answered;
  latencies_.push_back(*latency);
}

void LogReplay::fail_without_match() const {
  constexpr size_t kMostNamed = 10;
  std::string found;
  size_t named = 0;
  for (const auto& [channel, count] : counters_.other) {
    if (++named > kMostNamed) break;
    found += (found.empty() ? "" : ", ") + channel + " (" + std::to_string(count) + ")";
  }
  if (named > kMostNamed) found += " and " + std::to_string(counters_.other.size() - kMostNamed) + " more";
  std::string wanted;
  for (const std::string& channel : options_.channels) wanted += (wanted.empty() ? "" : " or ") + channel;
  throw InputError::at(path_.string(), "messages on " + (wanted.empty() ? "any channel" : wanted),
                       "only " + (found.empty() ? "none" : found), "--channel NAME or --all sends others");
}

}  // namespace edgepose
