#pragma once
#include "edgepose_lcm/service_status_t.hpp"
#include "server/registry.h"
#include "server/statistics.h"

namespace edgepose {

/// How the service is. `uptime`: [s].
edgepose_lcm::service_status_t status_message(const Statistics& statistics, const Registry& registry,
                                              double uptime);

}  // namespace edgepose
