#include "matcher/option_range.h"
#include "servoing/servo.h"

namespace edgepose {

std::string ServoOptions::check() const {
  for (const std::string& fault :
       {motion.check(), inverse.check(), approach.check(), gain.check(), gate.check(), history.check()})
    if (!fault.empty()) return fault;
  return option_fault({{"newest_share", newest_share, 0.01, 1},
                       {"confirming_poses", static_cast<double>(confirming_poses), 1, 100},
                       {"pose_timeout", pose_timeout, 0.05, 10},
                       {"lost_timeout", lost_timeout, pose_timeout, 600},
                       {"blocked_timeout", blocked_timeout, 0.1, 600},
                       {"goal_timeout", goal_timeout, 1, 3600},
                       {"max_following", max_following, 1e-4, 1}});
}

}  // namespace edgepose
