#include "server/metrics.h"

#include "files/number_text.h"
#include "server/memory_use.h"

namespace edgepose {
namespace {

/// Counters whose name ends in a cause become one metric with a label.
constexpr std::array<const char*, 2> kWithCause = {"frames_refused_", "commands_refused_"};

std::string head(const std::string& name, const std::string& type, const std::string& help) {
  return "# HELP edgepose_" + name + " " + help + "\n# TYPE edgepose_" + name + " " + type + "\n";
}

std::string gauge(const std::string& name, const std::string& help, double value) {
  return head(name, "gauge", help) + "edgepose_" + name + " " + number_text(value, 15) + "\n";
}

std::string counter_text(const Counters& counters) {
  std::string text, last;
  for (const auto& [name, value] : counters.all()) {
    std::string metric = name, label;
    for (const std::string family : kWithCause)
      if (name.starts_with(family)) {
        metric = family.substr(0, family.size() - 1);
        label = "{cause=\"" + name.substr(family.size()) + "\"}";
      }
    metric += "_total";
    if (metric != last) text += head(metric, "counter", "since the start");
    last = metric;
    text.append("edgepose_")
        .append(metric)
        .append(label)
        .append(" ")
        .append(std::to_string(value))
        .append("\n");
  }
  return text;
}

std::string histogram_text(const std::map<std::string, const Recent*>& stages) {
  std::string text = head("stage_seconds", "histogram", "wall time of a frame's stages");
  for (const auto& [stage, recent] : stages) {
    const Recent::Histogram h = recent->histogram();
    const std::string label = "stage=\"" + stage + "\"";
    for (size_t i = 0; i < Recent::kBuckets.size(); ++i)
      text += "edgepose_stage_seconds_bucket{" + label + ",le=\"" + number_text(Recent::kBuckets[i]) +
              "\"} " + std::to_string(h.at_most[i]) + "\n";
    text += "edgepose_stage_seconds_bucket{" + label + ",le=\"+Inf\"} " + std::to_string(h.count) + "\n";
    text += "edgepose_stage_seconds_sum{" + label + "} " + number_text(h.sum, 15) + "\n";
    text += "edgepose_stage_seconds_count{" + label + "} " + std::to_string(h.count) + "\n";
  }
  return text;
}

}  // namespace

std::string metrics_text(const Statistics& statistics, const Registry& registry) {
  const MemoryUse use = memory_use();
  return counter_text(statistics.counters) + histogram_text(statistics.stages()) +
         gauge("models", "registered", static_cast<double>(registry.all().size())) +
         gauge("models_active", "looked for in every frame", static_cast<double>(registry.active().size())) +
         gauge("models_broken", "whose files cannot be loaded",
               static_cast<double>(registry.broken().size())) +
         gauge("resident_bytes", "memory in use", static_cast<double>(use.resident_bytes)) +
         gauge("open_files", "descriptors in use", static_cast<double>(use.open_files));
}

}  // namespace edgepose
