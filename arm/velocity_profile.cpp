#include "arm/velocity_profile.h"

#include <algorithm>
#include <cmath>

namespace edgepose {
namespace {

AxisMotion with_jerk(const AxisMotion& s, double jerk, double t) {
  return {s.position + t * (s.velocity + t * (s.acceleration / 2 + t * jerk / 6)),
          s.velocity + t * (s.acceleration + t * jerk / 2), s.acceleration + t * jerk};
}

void widen(MotionExtent& extent, const AxisMotion& s) {
  extent.lowest = std::min(extent.lowest, s.position);
  extent.highest = std::max(extent.highest, s.position);
  extent.speed = std::max(extent.speed, std::abs(s.velocity));
}

/// The turning points of velocity and position inside a phase.
void widen_inside(MotionExtent& extent, const AxisMotion& s, double jerk, double duration) {
  const auto visit = [&](double t) {
    if (t > 0 && t < duration) widen(extent, with_jerk(s, jerk, t));
  };
  if (jerk == 0) {
    if (s.acceleration != 0) visit(-s.velocity / s.acceleration);
    return;
  }
  visit(-s.acceleration / jerk);
  const double discriminant = s.acceleration * s.acceleration - 2 * jerk * s.velocity;
  if (discriminant < 0) return;
  const double root = std::sqrt(discriminant);
  visit((-s.acceleration - root) / jerk);
  visit((-s.acceleration + root) / jerk);
}

}  // namespace

VelocityProfile velocity_profile(const AxisMotion& from, double target, double max_acceleration,
                                 double max_jerk) {
  // Seen from the target's velocity, and mirrored so that the velocity still there when the acceleration has
  // been taken back is positive: then brake, hold the braking, release.
  double v = from.velocity - target, a = from.acceleration;
  const double sign = v + a * std::abs(a) / (2 * max_jerk) < 0 ? -1 : 1;
  v *= sign;
  a *= sign;
  double peak = std::sqrt(std::max(0.0, max_jerk * v + a * a / 2)), hold = 0;
  if (peak > max_acceleration) {
    peak = max_acceleration;
    hold = (v + a * a / (2 * max_jerk)) / peak - peak / max_jerk;
  }
  VelocityProfile profile;
  profile.target = target;
  profile.phases = {{{std::max(0.0, (a + peak) / max_jerk), -sign * max_jerk},
                     {std::max(0.0, hold), 0},
                     {peak / max_jerk, sign * max_jerk}}};
  return profile;
}

double VelocityProfile::duration() const {
  return phases[0].duration + phases[1].duration + phases[2].duration;
}

AxisMotion VelocityProfile::after(AxisMotion from, double t) const {
  for (const Phase& phase : phases) {
    const double spent = std::min(t, phase.duration);
    if (spent > 0) from = with_jerk(from, phase.jerk, spent);
    t -= spent;
    if (t <= 0) return from;
  }
  return {from.position + t * target, target, 0};  // exact, so that nothing creeps
}

MotionExtent extent(const AxisMotion& from, const VelocityProfile& profile, double horizon) {
  MotionExtent result{from.position, from.position, std::abs(from.velocity)};
  AxisMotion state = from;
  for (const VelocityProfile::Phase& phase : profile.phases) {
    const double spent = std::min(horizon, phase.duration);
    if (spent <= 0) continue;
    widen_inside(result, state, phase.jerk, spent);
    state = with_jerk(state, phase.jerk, spent);
    widen(result, state);
    horizon -= spent;
  }
  return result;
}

bool can_stop(const AxisMotion& state, const AxisLimits& limits) {
  if (!(std::abs(state.acceleration) <= limits.acceleration)) return false;
  const MotionExtent stop = extent(state, velocity_profile(state, 0, limits.acceleration, limits.jerk));
  return stop.lowest >= limits.lower && stop.highest <= limits.upper && stop.speed <= limits.velocity;
}

}  // namespace edgepose
