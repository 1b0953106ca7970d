#include "canopen/drive_axis.h"

#include <algorithm>
#include <cmath>

namespace edgepose {
namespace {

/// Object 1001.
constexpr uint8_t kGeneric = 1 << 0, kTemperature = 1 << 3, kCommunication = 1 << 4, kProfile = 1 << 5;

uint8_t register_of(uint16_t code) {
  if (code == emergency_code::kNone) return 0;
  if ((code & 0xf000) == 0x4000) return kGeneric | kTemperature;
  if (code == emergency_code::kFollowingError) return kGeneric | kProfile;
  return (code & 0xff00) == 0x8100 || (code & 0xff00) == 0x8200 ? kGeneric | kCommunication : kGeneric;
}

}  // namespace

DriveAxis::DriveAxis(ObjectDictionary& objects, const DriveOptions& options)
    : objects_(objects),
      options_(options),
      motion_(options.position, options.lag, options.brake_deceleration) {
  motion_.set_sag(options.sag);
}

double DriveAxis::radians(ObjectId id) const {
  return static_cast<double>(objects_.value(id)) / options_.scale.counts_per_radian();
}

void DriveAxis::apply() {
  if (deaf_) return;
  const auto word = static_cast<uint16_t>(objects_.value(object::kControlword));
  objects_.set(object::kModeDisplay, objects_.value(object::kMode));
  const DriveState next = after_controlword(state_, word, previous_word_);
  previous_word_ = word;
  if (next != state_) enter(next);
  if (state_ != DriveState::kOperationEnabled ||
      objects_.value(object::kModeDisplay) != kCyclicSynchronousPosition)
    return;
  const double wanted = radians(object::kTargetPosition);
  const double low = radians(object::kMinPosition), high = std::max(low, radians(object::kMaxPosition));
  const double target = std::clamp(wanted, low, high);
  limited_ = target != wanted;
  const double time = static_cast<double>(objects_.value(object::kInterpolationTime)) *
                      std::pow(10.0, static_cast<double>(objects_.value(object::kInterpolationExponent)));
  motion_.set_target(target, time, radians(object::kMaxVelocity));
}

void DriveAxis::enter(DriveState state) {
  const bool was_fault = state_ == DriveState::kFault;
  state_ = state;
  switch (state) {
    case DriveState::kOperationEnabled:
      motion_.follow();
      break;
    case DriveState::kQuickStopActive:
    case DriveState::kFaultReactionActive:
      motion_.brake(radians(object::kQuickStopDeceleration));
      break;
    default:
      motion_.release();
  }
  limited_ = false;
  beyond_window_ = 0;
  if (was_fault && state == DriveState::kSwitchOnDisabled) report(emergency_code::kNone, 0);
}

void DriveAxis::advance(double duration) {
  motion_.advance(duration);
  check_following(duration);
  if (!motion_.at_rest()) return;
  if (state_ == DriveState::kFaultReactionActive) enter(DriveState::kFault);
  // 1 to 4: power off after the stop; 5 to 8: stays, with power.
  const bool goes_on = objects_.value(object::kQuickStopOption) <= 4;
  if (state_ == DriveState::kQuickStopActive && goes_on) enter(DriveState::kSwitchOnDisabled);
}

void DriveAxis::check_following(double duration) {
  const double error = std::abs(motion_.demand() - motion_.position());
  const bool beyond = state_ == DriveState::kOperationEnabled && error > radians(object::kFollowingWindow);
  beyond_window_ = beyond ? beyond_window_ + duration : 0;
  const double patience = static_cast<double>(objects_.value(object::kFollowingTimeout)) * 1e-3;
  if (beyond && beyond_window_ > patience) fail(emergency_code::kFollowingError);
}

void DriveAxis::refresh() {
  const JointScale& scale = options_.scale;
  uint16_t word = state_bits(state_) | statusword::kVoltageEnabled | statusword::kRemote;
  if (limited_) word |= statusword::kInternalLimit;
  if (motion_.at_rest()) word |= statusword::kTargetReached;
  if (state_ == DriveState::kOperationEnabled) word |= statusword::kFollowsCommand;
  if (beyond_window_ > 0) word |= statusword::kFollowingError;
  objects_.set(object::kStatusword, word);
  objects_.set(object::kPosition, scale.to_counts(motion_.position()));
  objects_.set(object::kVelocity, scale.to_counts(motion_.velocity()));
  objects_.set(object::kFollowingError, scale.to_counts(motion_.demand() - motion_.position()));
}

void DriveAxis::lose_connection(uint16_t code) {
  report(code, register_of(code));
  if (state_ != DriveState::kOperationEnabled) return;
  switch (objects_.value(object::kAbortOption)) {
    case 1:
      fail(code);
      break;
    case 2:
      enter(DriveState::kSwitchOnDisabled);
      break;
    case 3:
      enter(DriveState::kQuickStopActive);
      break;
    default:
      break;  // 0: goes on
  }
}

void DriveAxis::fail(uint16_t code) {
  if (state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive) return;
  report(code, register_of(code));
  enter(DriveState::kFaultReactionActive);
}

void DriveAxis::restart() {
  previous_word_ = 0;
  waiting_count_ = 0;
  enter(DriveState::kSwitchOnDisabled);
  waiting_count_ = 0;
}

void DriveAxis::cut_power() {
  previous_word_ = 0;
  const bool in_fault = state_ == DriveState::kFault || state_ == DriveState::kFaultReactionActive;
  enter(in_fault ? DriveState::kFault : DriveState::kSwitchOnDisabled);
}

/// EMCY, error register, error code and history (CiA 301, 7.5.2.4: the newest in 1003:01).
void DriveAxis::report(uint16_t code, uint8_t error_register) {
  objects_.set(object::kErrorRegister, error_register);
  objects_.set(object::kErrorCode, code);
  if (code != emergency_code::kNone) {
    const uint16_t history = object::kErrorCount.index;
    for (uint8_t i = 8; i > 1; --i)
      objects_.set({history, i}, objects_.value({history, static_cast<uint8_t>(i - 1)}));
    objects_.set({history, 1}, code);
    objects_.set(object::kErrorCount, std::min<int64_t>(8, objects_.value(object::kErrorCount) + 1));
  }
  if (waiting_count_ < kMaxWaiting)
    waiting_[waiting_count_++] = {.code = code, .error_register = error_register, .manufacturer = {}};
}

std::optional<Emergency> DriveAxis::take_emergency() {
  if (waiting_count_ == 0) return std::nullopt;
  const Emergency first = waiting_[0];
  std::move(waiting_.begin() + 1, waiting_.end(), waiting_.begin());
  --waiting_count_;
  return first;
}

}  // namespace edgepose
