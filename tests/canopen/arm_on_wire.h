#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bus/loop_wire.h"
#include "canopen/cob_id.h"
#include "canopen/drive.h"
#include "canopen/master.h"

namespace edgepose {

inline constexpr int64_t kMs = 1'000'000;

/// A master and six drives on one wire; time is what the test says. Cycles of 5 ms, drives in steps of 1 ms.
class ArmOnWire {
 public:
  explicit ArmOnWire(MasterOptions options = {}) : master_port(wire.port()), master(master_port, options) {
    for (int i = 0; i < kAxes; ++i) {
      DriveOptions drive;
      drive.node = i + 1;
      drive.position = 0.1 * i;
      set_points[static_cast<size_t>(i)] = drive.position;
      drives.push_back(std::make_unique<Drive>(wire.port(), drive, now));
    }
  }

  /// One cycle of master and drives.
  void cycle() {
    if (master_lives) master.cycle(now, set_points);
    for (int i = 0; i < 5; ++i) {
      for (const auto& drive : drives) drive->step(now);
      now += kMs;
    }
    ++cycles;
  }
  void cycles_of(int count) {
    for (int i = 0; i < count; ++i) cycle();
  }
  /// Until the master is in `phase`; at most `limit` cycles. The number of cycles it took.
  int until(MasterPhase phase, int limit = 2000) {
    int count = 0;
    for (; master.state().phase != phase && count < limit; ++count) cycle();
    return count;
  }
  void set_up() {
    ASSERT_TRUE(master.set_up(now));
    until(MasterPhase::kReady);
    ASSERT_EQ(master.state().phase, MasterPhase::kReady) << master.fault_text();
    cycles_of(3);
  }
  void enable() {
    set_up();
    ASSERT_EQ(master.enable(now), EnableResult::kBegun);
    until(MasterPhase::kEnabled);
    ASSERT_EQ(master.state().phase, MasterPhase::kEnabled) << master.fault_text();
    for (size_t i = 0; i < kAxes; ++i) set_points[i] = master.state().axes[i].position;
  }
  /// Moves all axes at `velocity` [rad/s] for `count` cycles.
  void move(double velocity, int count) {
    for (int i = 0; i < count; ++i) {
      for (double& point : set_points) point += velocity * 0.005;
      cycle();
    }
  }
  void enable_and_move(double velocity = 0.5) {
    enable();
    move(velocity, 40);
    ASSERT_EQ(master.state().phase, MasterPhase::kEnabled) << master.fault_text();
  }
  /// Cycles, moving on, from now until the controlword 02 has been on the wire for each of `nodes`; -1 if it
  /// was not within `limit`.
  int cycles_to_quick_stop(std::vector<int> nodes = {1, 2, 3, 4, 5, 6}, double velocity = 0.5,
                           int limit = 100) {
    const size_t from = wire.trace.size();
    for (int i = 1; i <= limit; ++i) {
      move(velocity, 1);
      const bool all =
          std::all_of(nodes.begin(), nodes.end(), [&](int node) { return stop_sent(from, node); });
      if (all) return i;
    }
    return -1;
  }
  bool stop_sent(size_t from, int node) const {
    return std::any_of(
        wire.trace.begin() + static_cast<std::ptrdiff_t>(from), wire.trace.end(),
        [&](const auto& f) { return f.id == cob_id::kRpdo1 + node && f.data[0] == 0x02 && f.data[1] == 0; });
  }
  /// [ms] until no axis moves any more; -1 if one still does after `limit`.
  int ms_to_rest(int limit = 1000) {
    const auto rests = [](const auto& drive) { return drive->velocity() == 0; };
    const int64_t from = now;
    while (now - from < limit * kMs) {
      cycle();
      if (std::all_of(drives.begin(), drives.end(), rests)) return static_cast<int>((now - from) / kMs);
    }
    return -1;
  }
  size_t count(uint16_t id, size_t from = 0) const {
    return static_cast<size_t>(std::count_if(wire.trace.begin() + static_cast<std::ptrdiff_t>(from),
                                             wire.trace.end(),
                                             [&](const CanFrame& f) { return f.id == id; }));
  }

  int64_t now = 1'000'000'000;
  LoopWire wire;
  LoopWire::Port& master_port;
  Master master;
  std::vector<std::unique_ptr<Drive>> drives;
  PerAxis<double> set_points{};
  bool master_lives = true;
  int cycles = 0;
};

}  // namespace edgepose
