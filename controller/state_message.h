#pragma once
#include <string>

#include "controller/arm_controller.h"
#include "edgepose_lcm/arm_state_t.hpp"

namespace edgepose {

/// The sample as it is published; send_utime is left for the sender.
edgepose_lcm::arm_state_t to_message(const ControlSample& sample, const std::string& fault,
                                     const std::string& target);

}  // namespace edgepose
