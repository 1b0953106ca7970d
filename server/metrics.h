#pragma once
#include <string>

#include "server/registry.h"
#include "server/statistics.h"

namespace edgepose {

/// What Prometheus reads (text format 0.0.4): counters, histograms of the stages [s], models, memory.
std::string metrics_text(const Statistics& statistics, const Registry& registry);

}  // namespace edgepose
