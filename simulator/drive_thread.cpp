#include "simulator/drive_thread.h"

#include <algorithm>

#include "bus/open_bus.h"
#include "bus/steady_clock.h"
#include "canopen/cob_id.h"
#include "common/error.h"
#include "daemon/log.h"
#include "daemon/real_time.h"

namespace edgepose {
namespace {

constexpr int64_t kStep = 1'000'000;  // [ns]
// Above all that keeps no time, below the controller's: on one processor the frames of a cycle are taken in
// one go, and not with a change of process for each (in user-mode Linux that would be more than it has time
// for).
constexpr int kDrivesPriority = 40;

/// What drives listen to; where the system can filter, nothing else costs them time.
std::vector<uint16_t> ids_of_drives() {
  std::vector<uint16_t> ids = {cob_id::kNmt, cob_id::kSync};
  for (uint16_t node = 1; node <= kJoints; ++node) {
    ids.push_back(static_cast<uint16_t>(cob_id::kRpdo1 + node));
    ids.push_back(static_cast<uint16_t>(cob_id::kSdoRequest + node));
  }
  // Whichever node is the master.
  for (uint16_t node = kJoints + 1; node <= cob_id::kMaxNode; ++node)
    ids.push_back(static_cast<uint16_t>(cob_id::kHeartbeat + node));
  return ids;
}

}  // namespace

/// The drives' connection: made anew when it was lost and the bus is still there.
class DriveThread::Port : public CanBus {
 public:
  explicit Port(const std::string& name) : name_(name) { open(); }

  void open() { bus_ = open_bus(name_, ids_of_drives()); }
  void close() { bus_.reset(); }

  SendResult send(const CanFrame& frame) override { return bus_ ? bus_->send(frame) : SendResult::kDown; }
  Received receive(int64_t deadline_ns) override { return bus_ ? bus_->receive(deadline_ns) : Received{}; }
  int descriptor() const override { return bus_ ? bus_->descriptor() : -1; }
  BusCounters counters() const override { return bus_ ? bus_->counters() : BusCounters{}; }

 private:
  const std::string name_;
  std::unique_ptr<CanBus> bus_;
};

DriveThread::DriveThread(SimulatedBus& bus, const SimulatedArmOptions& options, TruthLog* log)
    : bus_(bus), log_(log), port_(std::make_unique<Port>(bus.name())) {
  const int64_t now = steady_ns();
  arm_ = std::make_unique<SimulatedArm>(*port_, options, now);
  arm_->step(now);  // they have booted when this returns: who joins then is answered
  truth_ = truth_of(*arm_, now);
  thread_ = std::thread([this] { run(); });
}

DriveThread::~DriveThread() {
  ending_ = true;
  thread_.join();
}

TruthSample DriveThread::truth() const {
  const std::scoped_lock lock(mutex_);
  return truth_;
}

DriveTimes DriveThread::times() const {
  const std::scoped_lock lock(mutex_);
  return times_;
}

void DriveThread::with(const std::function<void(SimulatedArm&)>& work) {
  const std::scoped_lock lock(mutex_);
  work(*arm_);
}

void DriveThread::run() {
  become_real_time(kDrivesPriority);  // where it may: drives have processors of their own
  int64_t next = steady_ns();
  while (!ending_) {
    next += kStep;
    while (wait_for_input(port_->descriptor(), next) && steady_ns() < next) step(steady_ns());
    const int64_t now = steady_ns();
    step(now);
    if (log_ != nullptr) log_->add(truth());
    const std::scoped_lock lock(mutex_);
    ++times_.steps;
    times_.worst_late_ns = std::max(times_.worst_late_ns, now - next);
    if (now - next > kStep)
      next = now;  // what was missed is not made up for; the drives advance by the clock
  }
}

void DriveThread::step(int64_t now_ns) {
  const std::scoped_lock lock(mutex_);
  const bool lost = arm_->step(now_ns);
  truth_ = truth_of(*arm_, now_ns);
  if (!lost || !bus_.name().starts_with("unix:")) return;  // a CAN interface may come up again by itself
  port_->close();
  try {
    if (bus_.is_up()) port_->open();
  } catch (const InputError& error) {
    log_event(LogLevel::kWarning, "drives_off_the_bus", {{"reason", error.what()}});
  }
}

}  // namespace edgepose
