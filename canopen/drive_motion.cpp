#include "canopen/drive_motion.h"

#include <algorithm>
#include <cmath>

namespace edgepose {

DriveMotion::DriveMotion(double position, double lag, double brake_deceleration)
    : lag_(lag),
      brake_deceleration_(brake_deceleration),
      deceleration_(brake_deceleration),
      position_(position),
      demand_(position),
      target_(position) {}

void DriveMotion::follow() {
  following_ = true;
  demand_ = target_ = position_;
  time_left_ = 0;
}

void DriveMotion::set_target(double position, double duration, double max_velocity) {
  target_ = position;
  time_left_ = duration;
  max_velocity_ = max_velocity;
}

void DriveMotion::brake(double deceleration) {
  following_ = false;
  deceleration_ = deceleration;
}

void DriveMotion::release() { brake(brake_deceleration_); }

void DriveMotion::advance(double duration) {
  if (duration <= 0) return;
  if (following_) {
    const double share = time_left_ > duration ? duration / time_left_ : 1;
    const double limit = max_velocity_ * duration;
    demand_ += std::clamp((target_ - demand_) * share, -limit, limit);
    time_left_ = std::max(0.0, time_left_ - duration);
  }
  if (mobility_ == 0) {
    velocity_ = 0;
  } else if (following_) {
    // Exact for a demand that stands still; the steps are short against the lag.
    const double way = mobility_ * (demand_ + sag_ - position_) * (1 - std::exp(-duration / lag_));
    position_ += way;
    velocity_ = way / duration;
  } else {
    const double lost = std::min(std::abs(velocity_), deceleration_ * duration);
    const double after = velocity_ - std::copysign(lost, velocity_);
    // The last part takes less than the whole duration.
    position_ += (velocity_ + after) / 2 * (deceleration_ > 0 ? lost / deceleration_ : duration);
    velocity_ = std::abs(after) > 0 ? after : 0;
  }
  if (!following_) demand_ = target_ = position_;
}

}  // namespace edgepose
