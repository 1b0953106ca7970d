#include "server/worker.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "daemon/clock.h"
#include "daemon/log.h"
#include "files/number_text.h"
#include "matcher/stopwatch.h"

namespace edgepose {
namespace {

constexpr size_t kMaxJobs = 8;

int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// [s] since the frame was taken.
double age_of(const WaitingFrame& frame) {
  return 1e-6 * (static_cast<double>(utime_now()) - static_cast<double>(frame.depth.capture_utime));
}

/// Whether the whole image was searched for some model.
bool has_detection(const FrameAnswer& answer) {
  return std::any_of(answer.models.begin(), answer.models.end(),
                     [](const ModelAnswer& model) { return model.mode == AnswerMode::kDetection; });
}

void count(const FrameAnswer& answer, Counters& counters) {
  counters.add("frames_answered");
  if (answer.deadline_reached) {
    counters.add("deadlines_reached");
    log_limited(LogLevel::kWarning, "deadline_reached", "not every model was looked for in full",
                {{"advice", "fewer active models, or a longer service.deadline"}});
  }
  if (answer.tracks_lost > 0) counters.add("tracks_lost", static_cast<uint64_t>(answer.tracks_lost));
  if (answer.tracks_corrected > 0)
    counters.add("tracks_corrected", static_cast<uint64_t>(answer.tracks_corrected));
  for (const ModelAnswer& model : answer.models) {
    counters.add(model.mode == AnswerMode::kDetection  ? "answers_by_detection"
                 : model.mode == AnswerMode::kTracking ? "answers_by_tracking"
                                                       : "answers_skipped");
    if (!model.result.detections.empty() && model.result.detections.front().accepted)
      counters.add("models_found");
  }
}

}  // namespace

Worker::Worker(FrameMailbox& mailbox, const Registry& registry, const LiveOptions& options,
               AnswerPublisher& publisher, Statistics& statistics)
    : mailbox_(mailbox),
      registry_(registry),
      options_(options),
      publisher_(publisher),
      statistics_(statistics) {
  thread_ = std::thread([this] { run(); });
}

Worker::~Worker() {
  stopping_ = true;
  mailbox_.wake();
  thread_.join();
}

bool Worker::post(Job job) {
  {
    const std::scoped_lock lock(mutex_);
    if (jobs_.size() >= kMaxJobs) return false;
    jobs_.push_back(std::move(job));
  }
  mailbox_.wake();
  return true;
}

double Worker::stuck_for() const {
  const int64_t since = busy_since_;
  return since == 0 ? 0 : 1e-6 * static_cast<double>(steady_us() - since);
}

void Worker::run() {
  while (!stopping_) {
    std::optional<WaitingFrame> frame = mailbox_.take();
    busy_since_ = steady_us();
    if (frame) answer(std::move(*frame));
    do_one_job();
    busy_since_ = 0;
  }
}

/// Waiting made it too old: as if it had come so late.
bool Worker::is_expired(const WaitingFrame& frame, double max_age) {
  if (age_of(frame) <= max_age) return false;
  statistics_.counters.add("frames_refused_too_old");
  for (const auto& [cause, count] : frame.dropped) mailbox_.note_dropped(frame.depth.camera, cause, count);
  mailbox_.note_dropped(frame.depth.camera, "too_old", 1);
  log_limited(
      LogLevel::kWarning, "frame_refused", "too_old",
      {{"camera", frame.depth.camera}, {"detail", "it has waited for the frames and commands before it"}});
  return true;
}

void Worker::answer(WaitingFrame&& frame) {
  try {
    const auto options = options_.get();
    if (is_expired(frame, options->frames.max_age)) return;
    statistics_.waiting.add(1e-6 * static_cast<double>(utime_now() - frame.receive_utime));
    Stopwatch watch;
    const FrameAnswer answer = answerer_.answer(
        frame.depth, registry_.active(),
        {options->matcher.scene, options->matcher.match, options->tracking, options->deadline});
    const double seconds = watch.lap();
    (has_detection(answer) ? statistics_.detecting : statistics_.tracking).add(seconds);
    statistics_.preprocessing.add(answer.preprocessing_seconds);

    statistics_.note_frame({frame.depth.camera, frame.depth.sequence, frame.depth.capture_utime});
    edgepose_lcm::pose_estimates_t poses = to_poses(frame, answer);
    edgepose_lcm::drill_targets_t targets =
        to_drill_targets(frame, answer, {options->min_margin, options->frames.max_age}, age_of(frame));
    const int64_t sent = publisher_.publish(poses, targets);
    count(answer, statistics_.counters);
    if (sent == 0) {
      statistics_.counters.add("answers_not_sent");
      log_limited(LogLevel::kError, "answer_not_sent", "the system refused it", {});
      last_ = std::move(frame.depth);
      return;
    }
    statistics_.latency.add(1e-6 * static_cast<double>(sent - frame.depth.capture_utime));
    statistics_.service_time.add(1e-6 * static_cast<double>(sent - frame.receive_utime));
    log_event(LogLevel::kDebug, "frame_answered",
              {{"camera", frame.depth.camera},
               {"sequence", std::to_string(frame.depth.sequence)},
               {"mode", has_detection(answer) ? "detection" : "tracking"},
               {"ms", number_text(1e-3 * static_cast<double>(sent - frame.receive_utime), 4)}});
  } catch (const std::exception& error) {
    // One frame is not worth the service: what went wrong is counted, and the next frame is looked at.
    statistics_.counters.add("frames_failed");
    log_limited(LogLevel::kError, "frame_failed", error.what(), {});
  }
  last_ = std::move(frame.depth);
}

/// One between two frames: whoever asks for more does not hold up the camera.
void Worker::do_one_job() {
  Job job;
  bool more = false;
  {
    const std::scoped_lock lock(mutex_);
    if (jobs_.empty() || stopping_) return;
    job = std::move(jobs_.front());
    jobs_.pop_front();
    more = !jobs_.empty();
  }
  busy_since_ = steady_us();  // for itself: a queue of sound jobs is not a worker that is stuck
  job(last_ ? &*last_ : nullptr);
  if (more) mailbox_.wake();
}

}  // namespace edgepose
