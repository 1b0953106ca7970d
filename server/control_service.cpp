/// The commands that are about the service itself.
#include "daemon/clock.h"
#include "daemon/json_text.h"
#include "daemon/params.h"
#include "server/control.h"
#include "server/memory_use.h"

namespace edgepose {
namespace {

using nlohmann::json;

json summary(const Recent& recent) {
  return {{"p50", recent.quantile(0.5)}, {"p99", recent.quantile(0.99)}, {"count", recent.histogram().count}};
}

json value_of(const SettingKey& key) {
  return std::visit(
      [&](auto* field) -> json {
        if constexpr (std::is_same_v<decltype(field), Verification*>) {
          const std::string quoted = to_toml(key);
          return quoted.substr(1, quoted.size() - 2);
        } else {
          return *field;
        }
      },
      key.field);
}

}  // namespace

Control::Reply Control::status(const Call& call) {
  const Params params(call.request.params, {});
  const Statistics& statistics = parts_.statistics;
  json last;
  if (const auto frame = statistics.last_frame())
    last = {
        {"camera", frame->camera}, {"sequence", frame->sequence}, {"capture_utime", frame->capture_utime}};
  return text_of({{"version", facts_.version},
                  {"uptime", 1e-6 * static_cast<double>(utime_now() - facts_.start_utime)},
                  {"ready", true},
                  {"lcm_url", facts_.lcm_url},
                  {"receive_buffer_bytes", facts_.receive_buffer_bytes},
                  {"authentication", parts_.key.has_value()},
                  {"models", parts_.registry.all().size()},
                  {"active_models", parts_.registry.active().size()},
                  {"broken_models", parts_.registry.broken().size()},
                  {"frames", statistics.counters.get("frames_answered")},
                  {"latency", summary(statistics.latency)},
                  {"last_frame", last},
                  {"training", parts_.registrar.pending()}});
}

Control::Reply Control::stats(const Call& call) {
  const Params params(call.request.params, {});
  json stages;
  for (const auto& [name, recent] : parts_.statistics.stages()) stages[name] = summary(*recent);
  return text_of({{"counters", parts_.statistics.counters.all()},
                  {"stages", stages},
                  {"memory_bytes", memory_use().resident_bytes},
                  {"threads", memory_use().threads}});
}

Control::Reply Control::get_config(const Call& call) {
  const Params params(call.request.params, {});
  ServiceOptions options = *parts_.options.get();
  json values;
  for (const SettingKey& key : service_keys(options)) values[key.path] = value_of(key);
  values["config_file"] = facts_.config_file;
  return text_of(values);
}

Control::Reply Control::shutdown(const Call& call) {
  const Params params(call.request.params, {});
  parts_.shutdown();
  return text_of({{"stopping", true}});
}

}  // namespace edgepose
