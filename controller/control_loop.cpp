#include "controller/control_loop.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "bus/steady_clock.h"
#include "daemon/real_time.h"

namespace edgepose {

ControlLoop::ControlLoop(std::unique_ptr<CanBus> bus,
                         const std::function<std::unique_ptr<ArmController>(CanBus&)>& make, PoseInbox& poses,
                         double cycle, int rt_priority)
    : bus_(std::move(bus), frames_),
      controller_(make(bus_)),
      poses_(poses),
      cycle_(cycle),
      rt_priority_(rt_priority) {}

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
  thread_ = std::thread([this] { run(); });
  started_.wait(false);
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
  if (!thread_.joinable()) return;
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
  thread_.join();
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

void ControlLoop::run() {
  if (rt_priority_ > 0) {
    std::string fault = become_real_time(rt_priority_);
    if (fault.empty()) fault = lock_memory();
    const std::scoped_lock lock(mutex_);
    real_time_fault_ = std::move(fault);
  }
  started_ = true;
  started_.notify_one();
  CycleClock clock(static_cast<int64_t>(cycle_ * 1e9));
  while (!ending_) {
    const int64_t deadline = clock.wait(times_);
    const int64_t now = steady_ns();
    serve_requests(now);
    if (releasing_ && !controller_->is_moving(now)) controller_->release();
    const ControlSample& sample = controller_->cycle(now, poses_.take_reading());
    samples_.push(sample);
    show(sample);
    times_.add(now - deadline, steady_ns() - now);
  }
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
