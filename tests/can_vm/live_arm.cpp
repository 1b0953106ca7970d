#include "tests/can_vm/live_arm.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <algorithm>

#include "bus/open_bus.h"
#include "bus/steady_clock.h"
#include "bus/tapped_bus.h"
#include "canopen/cob_id.h"

namespace edgepose {
namespace {

constexpr int64_t kMs = 1'000'000;

/// As a controller runs, where it is allowed to: before all that is not real-time.
void prefer(pthread_t thread, int priority) {
  const sched_param parameter{.sched_priority = priority};
  pthread_setschedparam(thread, SCHED_FIFO, &parameter);
}

}  // namespace

LiveArm::LiveArm(const std::filesystem::path& trace, const MasterOptions& options)
    : master_bus_(open_bus("vcan0", options.received_ids(), {cob_id::kSync})),
      drives_bus_(std::make_unique<TappedBus>(open_bus("vcan0"),
                                              std::make_unique<PcapWriter>(trace, wall_minus_steady_ns()))),
      master_(std::make_unique<Master>(*master_bus_, options)) {
  for (int i = 0; i < kAxes; ++i) {
    DriveOptions drive;
    drive.node = options.nodes[static_cast<size_t>(i)];
    drive.position = 0.1 * i;
    drives_.push_back(std::make_unique<Drive>(*drives_bus_, drive, steady_ns()));
  }
  drives_thread_ = std::thread([this] { run_drives(); });
  prefer(pthread_self(), 30);
  prefer(drives_thread_.native_handle(), 20);
}

LiveArm::~LiveArm() {
  ends_ = true;
  drives_thread_.join();
  const sched_param normal{.sched_priority = 0};
  pthread_setschedparam(pthread_self(), SCHED_OTHER, &normal);
}

void LiveArm::run_drives() {
  int64_t next = steady_ns();
  while (!ends_) {
    const Received in = drives_bus_->receive(next);
    const int64_t now = steady_ns();
    const std::lock_guard lock(lock_);
    if (in.kind == Received::Kind::kFrame) {
      heard_.push_back(in.frame);
      for (const auto& drive : drives_) drive->take(in.frame, now);
    }
    if (now < next) continue;
    for (const auto& drive : drives_) drive->advance(now);
    next = std::max(next + 2 * kMs, now);
  }
}

bool LiveArm::run_until(const std::function<bool()>& done, double limit, double velocity) {
  const int64_t end = steady_ns() + static_cast<int64_t>(limit * 1e9);
  next_ns_ = std::max(next_ns_, steady_ns());
  while (steady_ns() < end) {
    wait_for_input(-1, next_ns_);
    const int64_t now = steady_ns();
    worst_lateness_ns_ = std::max(worst_lateness_ns_, now - next_ns_);
    for (double& point : set_points_) point += velocity * 0.005;
    master_->cycle(now, set_points_);
    next_ns_ += 5 * kMs;
    if (done()) return true;
  }
  return false;
}

bool LiveArm::run_until(MasterPhase phase, double limit, double velocity) {
  const auto there = [&] {
    return master_->state().phase == phase || master_->state().phase == MasterPhase::kFault;
  };
  return run_until(there, limit, velocity) && master_->state().phase == phase;
}

void LiveArm::enable() {
  run_for(0.1);  // the drives boot; who boots again in the set-up is taken for a second node of that number
  ASSERT_TRUE(master_->set_up(steady_ns()));
  ASSERT_TRUE(run_until(MasterPhase::kReady, 5)) << master_->fault_text();
  run_for(0.05);
  // Not while the answer to the last SYNC is still under way.
  ASSERT_TRUE(run_until([&] { return master_->enable(steady_ns()) == EnableResult::kBegun; }, 1))
      << master_->fault_text();
  ASSERT_TRUE(run_until(MasterPhase::kEnabled, 5)) << master_->fault_text();
  for (size_t i = 0; i < kAxes; ++i) set_points_[i] = master_->state().axes[i].position;
}

void LiveArm::provoke(int drive, Provocation kind) {
  const std::lock_guard lock(lock_);
  drives_.at(static_cast<size_t>(drive))->provoke(kind);
}

PerAxis<double> LiveArm::positions() {
  const std::lock_guard lock(lock_);
  PerAxis<double> all{};
  for (size_t i = 0; i < kAxes; ++i) all[i] = drives_[i]->position();
  return all;
}

PerAxis<DriveState> LiveArm::states() {
  const std::lock_guard lock(lock_);
  PerAxis<DriveState> all{};
  for (size_t i = 0; i < kAxes; ++i) all[i] = drives_[i]->state();
  return all;
}

bool LiveArm::rests() {
  const std::lock_guard lock(lock_);
  return std::all_of(drives_.begin(), drives_.end(), [](const auto& one) { return one->velocity() == 0; });
}

std::vector<CanFrame> LiveArm::heard() {
  const std::lock_guard lock(lock_);
  return heard_;
}

}  // namespace edgepose
