#pragma once
#include <atomic>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "server/answer_publisher.h"
#include "server/frame_answer.h"
#include "server/live_options.h"
#include "server/registry.h"
#include "server/statistics.h"

namespace edgepose {

/// The thread that looks at frames: takes the newest, answers it with all active models, publishes. Work that
/// others ask for (detect) is done in between, so that nothing ever matches beside it.
class Worker {
 public:
  /// Called on the worker's thread with the last frame taken (nullptr before the first).
  using Job = std::function<void(const DepthFrame* last)>;

  Worker(FrameMailbox& mailbox, const Registry& registry, const LiveOptions& options,
         AnswerPublisher& publisher, Statistics& statistics);
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker();  ///< the frame at hand is finished; jobs that wait are not done

  /// False if too many wait already. One is done after each frame; it must look at stopping() and be bounded.
  bool post(Job job);
  bool stopping() const { return stopping_; }
  /// [s] since the worker last showed that it goes on; small while idle.
  double stuck_for() const;

 private:
  void run();
  void answer(WaitingFrame&& frame);
  void do_one_job();
  bool is_expired(const WaitingFrame& frame, double max_age);

  FrameMailbox& mailbox_;
  const Registry& registry_;
  const LiveOptions& options_;
  AnswerPublisher& publisher_;
  Statistics& statistics_;
  FrameAnswerer answerer_;
  std::optional<DepthFrame> last_;
  std::atomic<int64_t> busy_since_ = 0;  // [us] on the steady clock; 0 = idle
  std::atomic<bool> stopping_ = false;
  std::mutex mutex_;
  std::deque<Job> jobs_;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace edgepose
