#include "controller/state_message.h"

#include <algorithm>

namespace edgepose {
namespace {

template <class Vector>
void copy(const Vector& from, double* to) {
  std::copy(from.begin(), from.end(), to);
}

}  // namespace

edgepose_lcm::arm_state_t to_message(const ControlSample& sample, const std::string& fault,
                                     const std::string& target) {
  edgepose_lcm::arm_state_t m{};
  const ServoSample& s = sample.servo;
  m.state = state_name(s.state);
  m.fault = fault;
  m.target = target;
  copy(s.measured, m.measured);
  copy(s.command.position, m.commanded);
  copy(s.command.velocity, m.velocity);
  m.goal_seen = s.goal_seen;
  copy(s.features, m.features);
  m.tool_error = s.tool_error.translation;
  m.tool_angle = s.tool_error.rotation;
  m.standoff = s.standoff;
  copy(s.camera_twist, m.camera_velocity);
  m.condition = s.condition;
  m.poses_taken = static_cast<int64_t>(sample.poses_taken);
  m.poses_refused = static_cast<int64_t>(sample.poses_refused);
  return m;
}

}  // namespace edgepose
