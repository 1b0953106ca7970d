#include "client/service/recorder.h"

#include <chrono>

#include "common/error.h"

namespace edgepose {
namespace {

using std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kFlushInterval = 200ms;
constexpr size_t kMaxChannels = 1000;

}  // namespace

Recorder::Recorder(const std::filesystem::path& path, LcmLogWriter::Existing existing, const Options& options)
    : options_(options), queue_(options.queue_bytes), writer_(path, existing), thread_([this] { run(); }) {}

Recorder::~Recorder() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
}

void Recorder::take(ReceivedMessage&& message) {
  if (!options_.channels.empty() && !options_.channels.contains(message.channel)) return;
  queue_.push({utime_now(), std::move(message)});
}

void Recorder::run() {
  try {
    SteadyTime flush_at = steady_clock::now() + kFlushInterval;
    while (true) {
      const auto message = queue_.pop({}, flush_at);
      if (message) write(*message);
      if (!message && queue_.is_closed()) break;
      if (steady_clock::now() < flush_at) continue;
      writer_.flush();
      flush_at = steady_clock::now() + kFlushInterval;
    }
    writer_.close();
  } catch (...) {
    failure_ = std::current_exception();
    queue_.close();
  }
  const std::scoped_lock lock(mutex_);
  counters_.messages = writer_.records(), counters_.bytes = writer_.bytes();
  done_ = true;
  changed_.notify_all();
}

void Recorder::write(const TimedMessage& timed) {
  {
    const std::scoped_lock lock(mutex_);
    if (options_.max_messages > 0 && counters_.messages >= options_.max_messages) return;
  }
  try {
    writer_.write(timed.receive_utime, timed.message.channel, timed.message.data());
  } catch (const std::invalid_argument&) {
    const std::scoped_lock lock(mutex_);
    ++counters_.refused;
    return;
  }
  const std::scoped_lock lock(mutex_);
  counters_.messages = writer_.records(), counters_.bytes = writer_.bytes();
  if (counters_.channels.contains(timed.message.channel) || counters_.channels.size() < kMaxChannels)
    ++counters_.channels[timed.message.channel];
  if (options_.max_messages > 0 && counters_.messages >= options_.max_messages) {
    done_ = true;
    changed_.notify_all();
  }
}

void Recorder::wait(const std::stop_token& stop, SteadyTime deadline) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, stop, deadline, [&] { return done_; });
}

void Recorder::finish() {
  queue_.close();
  if (thread_.joinable()) thread_.join();
  if (failure_) std::rethrow_exception(failure_);
}

RecordCounters Recorder::counters() const {
  const std::scoped_lock lock(mutex_);
  RecordCounters counters = counters_;
  counters.dropped = queue_.dropped();
  return counters;
}

}  // namespace edgepose
