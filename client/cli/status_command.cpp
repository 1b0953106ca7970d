#include "client/cli/status_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/cli/control_options.h"
#include "client/cli/match_report.h"
#include "client/cli/text.h"
#include "common/error.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr const char* kStatusExamples = R"(Examples:
  edgepose status
  edgepose status --stats                  # counters, and how long each stage takes
  edgepose status --settings --json        # every key of the configuration, as it is in effect

Exit code: 0 if the daemon answers, 2 if not.)";

void print_status(std::ostream& out, const json& status) {
  const auto say = [&](const char* label, const std::string& text) {
    out << formatted("%-16s ", label) << text << '\n';
  };
  say("edgeposed", text_of(status, "version") + ", up " + number_of(status, "uptime", 1, 0) + " s");
  say("ready", text_of(status, "ready"));
  say("lcm",
      text_of(status, "lcm_url") + ", receive buffer " + text_of(status, "receive_buffer_bytes") + " bytes");
  say("authentication", text_of(status, "authentication"));
  say("models", text_of(status, "models"));
  say("active models", text_of(status, "active_models"));
  say("training", text_of(status, "training"));
  say("frames", text_of(status, "frames"));
  const json& latency = member(status, "latency");
  say("latency", "p50 " + number_of(latency, "p50", 1e3, 1) + " ms, p99 " +
                     number_of(latency, "p99", 1e3, 1) + " ms, of " + text_of(latency, "count") + " answers");
  const json& last = member(status, "last_frame");
  say("last frame",
      last.is_object() ? text_of(last, "camera") + " " + text_of(last, "sequence") : "none yet");
}

void print_stats(std::ostream& out, const json& stats) {
  out << formatted("%-32s %12s\n", "counter", "value");
  const json& counters = member(stats, "counters");
  if (counters.is_object())
    for (const auto& [name, value] : counters.items())
      out << formatted("%-32.32s %12s\n", one_line(name).c_str(), text_of(counters, name.c_str()).c_str());
  out << formatted("%-32s %12s %12s %12s\n", "stage", "p50 [ms]", "p99 [ms]", "count");
  const json& stages = member(stats, "stages");
  if (stages.is_object())
    for (const auto& [name, stage] : stages.items())
      out << formatted("%-32.32s %12s %12s %12s\n", one_line(name).c_str(),
                       number_of(stage, "p50", 1e3, 2).c_str(), number_of(stage, "p99", 1e3, 2).c_str(),
                       text_of(stage, "count").c_str());
  out << "memory " << number_of(stats, "memory_bytes", 1e-6, 1) << " MB, threads "
      << text_of(stats, "threads") << '\n';
}

void print_settings(std::ostream& out, const json& settings) {
  if (!settings.is_object()) return;
  for (const auto& [key, value] : settings.items())
    out << one_line(key) << " = " << text_of(settings, key.c_str()) << '\n';
}

struct StatusCommand {
  ControlOptions control;
  bool stats = false, settings = false;

  void run() const {
    const json answer = control.call(stats ? "stats" : settings ? "config.get" : "status", nullptr);
    if (control.as_json) return print_json(std::cout, answer);
    (stats ? print_stats : settings ? print_settings : print_status)(std::cout, answer);
  }
};

}  // namespace

void add_status_command(CLI::App& app) {
  auto command = std::make_shared<StatusCommand>();
  CLI::App* status = app.add_subcommand("status", "How the daemon is");
  auto* stats = status->add_flag("--stats", command->stats, "Counters, times of the stages, memory");
  status->add_flag("--settings", command->settings, "The configuration in effect")->excludes(stats);
  command->control.add_to(*status);
  status->footer(kStatusExamples);
  status->callback([command] { command->run(); });
}

}  // namespace edgepose
