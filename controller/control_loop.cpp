#include "controller/control_loop.h"

#include <algorithm>
#include <chrono>
#include <system_error>
#include <utility>

#include "bus/steady_clock.h"
#include "daemon/real_time.h"

namespace edgepose {
namespace {

/// From the last on: the first serves most interrupts. A thread without priority is moved to where there is
/// room.
std::vector<size_t> processors_for(const RealTime& real_time) {
  if (real_time.priority == 0 || real_time.processors < 2) return {};
  std::vector<size_t> processors = allowed_processors();
  std::reverse(processors.begin(), processors.end());
  if (processors.size() > static_cast<size_t>(real_time.processors))
    processors.resize(static_cast<size_t>(real_time.processors));
  return processors;
}

}  // namespace

ControlLoop::ControlLoop(std::unique_ptr<CanBus> bus,
                         const std::function<std::unique_ptr<ArmController>(CanBus&)>& make, PoseInbox& poses,
                         double cycle, const RealTime& real_time)
    : bus_(std::move(bus), frames_),
      controller_(make(bus_)),
      poses_(poses),
      cycle_(cycle),
      real_time_(real_time),
      processors_(processors_for(real_time)),
      clock_(static_cast<int64_t>(cycle * 1e9)),
      started_(static_cast<ptrdiff_t>(std::max<size_t>(processors_.size(), 1)) + 1) {}

ControlLoop::~ControlLoop() { finish(0); }

/// Whether any axis may still have power.
bool ControlLoop::has_power(const ControlSample& sample) {
  switch (sample.phase) {
    case MasterPhase::kIdle:
    case MasterPhase::kSettingUp:
    case MasterPhase::kReady:
      return false;
    case MasterPhase::kFault:
      return std::any_of(sample.statusword.begin(), sample.statusword.end(), [](uint16_t word) {
        const DriveState state = state_of(word);
        return state == DriveState::kOperationEnabled || state == DriveState::kQuickStopActive;
      });
    default:
      return true;
  }
}

void ControlLoop::start() {
  const size_t count = std::max<size_t>(processors_.size(), 1);
  try {
    for (size_t i = 0; i < count; ++i) {
      std::optional<size_t> processor;
      if (!processors_.empty()) processor = processors_[i];
      threads_.emplace_back([this, processor] { run(processor); });
    }
  } catch (const std::system_error&) {  // those that there are end
    ending_ = true;
    started_.count_down(static_cast<ptrdiff_t>(count - threads_.size()) + 1);
    throw;
  }
  if (real_time_.priority > 0)
    if (std::string fault = lock_memory(); !fault.empty()) {
      const std::scoped_lock lock(mutex_);
      real_time_fault_ = std::move(fault);
    }
  clock_.begin();
  started_.arrive_and_wait();
}

bool ControlLoop::post(const ArmRequest& request) {
  const std::scoped_lock lock(mutex_);
  if (busy_) return false;
  busy_ = true;
  request_ = request;
  return true;
}

std::optional<std::string> ControlLoop::take_answer() {
  const std::scoped_lock lock(mutex_);
  if (!answer_) return std::nullopt;
  busy_ = false;
  return std::exchange(answer_, std::nullopt);
}

void ControlLoop::finish(double seconds) {
  if (threads_.empty()) return;
  stop_ = true;
  const auto pause = [&] { std::this_thread::sleep_for(std::chrono::duration<double>(cycle_)); };
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  const auto goes_on = [&] { return std::chrono::steady_clock::now() < end; };
  for (int i = 0; i < 4 && goes_on(); ++i) pause();  // the stop has been taken
  while (has_power(newest()) && goes_on()) {
    releasing_ = newest().phase == MasterPhase::kFault;
    pause();
  }
  ending_ = true;
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

ControlSample ControlLoop::newest() const {
  const std::scoped_lock lock(mutex_);
  return newest_;
}

std::string ControlLoop::fault_text() const {
  const std::scoped_lock lock(mutex_);
  return fault_text_;
}

std::string ControlLoop::real_time_fault() const {
  const std::scoped_lock lock(mutex_);
  return real_time_fault_;
}

void ControlLoop::run(std::optional<size_t> processor) {
  if (real_time_.priority > 0) {
    std::string fault = become_real_time(real_time_.priority);
    if (fault.empty() && processor) fault = stay_on(*processor);
    const std::scoped_lock lock(mutex_);
    if (!fault.empty()) real_time_fault_ = std::move(fault);
  }
  started_.arrive_and_wait();
  CycleClock::Sleeper sleeper(clock_);
  while (!ending_) {
    const std::optional<int64_t> deadline = sleeper.wait();
    if (!deadline) continue;
    const int64_t now = steady_ns();
    work(now);
    times_.add(now - *deadline, steady_ns() - *deadline);
    clock_.done(times_);
  }
}

void ControlLoop::work(int64_t now_ns) {
  serve_requests(now_ns);
  if (releasing_ && !controller_->is_moving(now_ns)) controller_->release();
  const ControlSample& sample = controller_->cycle(now_ns, poses_.take_reading());
  samples_.push(sample);
  show(sample);
}

void ControlLoop::serve_requests(int64_t now_ns) {
  if (stop_.exchange(false)) {
    controller_->stop(now_ns);
    drops_request_ = true;
  }
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  if (drops_request_ && request_) {
    request_.reset();
    answer_ = "stopped before it was begun";
  }
  drops_request_ = false;
  if (request_ && controller_->request(*request_)) request_.reset();
  if (!answer_) answer_ = controller_->take_answer();
}

void ControlLoop::show(const ControlSample& sample) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  const bool is_fault = sample.servo.state == ServoState::kFault;
  if (is_fault && (fault_text_.empty() || newest_.servo.state != ServoState::kFault))
    fault_text_ = controller_->fault_text();
  if (!is_fault) fault_text_.clear();
  newest_ = sample;
}

}  // namespace edgepose
