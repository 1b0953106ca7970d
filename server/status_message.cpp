#include "server/status_message.h"

namespace edgepose {

edgepose_lcm::service_status_t status_message(const Statistics& statistics, const Registry& registry,
                                              double uptime) {
  edgepose_lcm::service_status_t m{};
  m.uptime = uptime;
  m.version = EDGEPOSE_VERSION;
  m.latency_p50 = statistics.latency.quantile(0.5);
  m.latency_p99 = statistics.latency.quantile(0.99);
  for (const ModelHandle& model : registry.active()) m.models.push_back(model->name);
  m.models_count = static_cast<int32_t>(m.models.size());
  for (const auto& [name, value] : statistics.counters.all())
    m.counters.push_back({name, static_cast<int64_t>(value)});
  m.counters_count = static_cast<int32_t>(m.counters.size());
  return m;
}

}  // namespace edgepose
