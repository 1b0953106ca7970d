#pragma once

namespace edgepose {

/// The axis of a simulated drive: demanded position and what becomes of it. [rad], [s].
class DriveMotion {
 public:
  DriveMotion(double position, double lag, double brake_deceleration);

  /// Demand and axis are one from now on; set_target() moves them.
  void follow();
  /// The demand goes to `position` in a straight line within `duration`, but no faster than `max_velocity`.
  void set_target(double position, double duration, double max_velocity);
  /// Comes to rest with this deceleration, power on.
  void brake(double deceleration);
  /// Power off: the holding brake stops the axis.
  void release();
  /// How much of its way the axis makes: 1 as it should, 0 blocked.
  void set_mobility(double share) { mobility_ = share; }
  /// [rad] the axis rests so far beside its demand.
  void set_sag(double sag) { sag_ = sag; }

  void advance(double duration);

  double position() const { return position_; }
  double velocity() const { return velocity_; }
  double demand() const { return demand_; }
  bool at_rest() const { return velocity_ == 0; }

 private:
  double lag_, brake_deceleration_;
  bool following_ = false;
  double mobility_ = 1, sag_ = 0;
  double deceleration_;
  double position_, velocity_ = 0;
  double demand_, target_, time_left_ = 0, max_velocity_ = 0;
};

}  // namespace edgepose
