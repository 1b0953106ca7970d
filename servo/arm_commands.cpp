#include "servo/arm_commands.h"

#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/service/control_client.h"
#include "controller/controller_options.h"

namespace edgepose {
namespace {

using nlohmann::json;

/// Where the controller is, and what is asked of it.
struct Command {
  std::filesystem::path socket;
  std::string target;
  double timeout = 10;
  bool as_json = false;

  json call(const std::string& method, const json& params = nullptr) const {
    ControlAddress address;
    address.socket = socket.empty() ? default_servo_socket() : socket;
    address.program = "edgepose-servo";
    address.advice = "start it: edgepose-servo run; --socket or EDGEPOSE_SERVO_SOCKET name another place";
    return ControlClient(address, std::nullopt).call(method, params, timeout);
  }
};

std::string text(const json& object, const char* key) {
  const auto found = object.find(key);
  if (found == object.end() || found->is_null()) return "-";
  if (found->is_string()) return found->get<std::string>().empty() ? "-" : one_line(*found);
  if (found->is_boolean()) return found->get<bool>() ? "yes" : "no";
  return found->dump();
}

std::string number(const json& object, const char* key, double factor, const char* format) {
  const auto found = object.find(key);
  if (found == object.end() || !found->is_number()) return "-";
  char shown[48];
  std::snprintf(shown, sizeof(shown), format, factor * found->get<double>());
  return shown;
}

void print_status(const json& s) {
  const auto say = [](const char* label, const std::string& value) {
    std::printf("%-16s %s\n", label, value.c_str());
  };
  say("state", text(s, "state"));
  if (text(s, "fault") != "-") say("fault", text(s, "fault"));
  say("drives", text(s, "drives") + " on " + text(s, "bus"));
  say("model", text(s, "model") + (text(s, "taught") == "yes" ? ", taught" : ", not taught"));
  say("target", text(s, "target"));
  const auto goal = s.find("goal");
  if (goal != s.end() && goal->is_object())
    say("to the goal", number(*goal, "tool_error_m", 1e3, "%.2f mm, ") +
                           number(*goal, "tool_angle_rad", 180 / M_PI, "%.2f degrees; goal ") +
                           number(*goal, "standoff_m", 1e3, "%.1f mm before the entry"));
  say("poses", text(s, "poses_taken") + " taken, " + text(s, "poses_refused") +
                   " refused; signed only: " + text(s, "authentication"));
  say("cycle", "late p50 " + number(s, "late_p50_s", 1e6, "%.0f us, p99.9 ") +
                   number(s, "late_p99.9_s", 1e6, "%.0f us, worst ") +
                   number(s, "late_worst_s", 1e6, "%.0f us; ") + text(s, "cycles_missed") + " of " +
                   text(s, "cycles") + " left out");
  if (text(s, "not_real_time") != "-") say("not real-time", text(s, "not_real_time"));
}

void add(CLI::App& app, const std::string& name, const std::string& help, const std::string& done) {
  auto command = std::make_shared<Command>();
  CLI::App* sub = app.add_subcommand(name, help);
  if (name == "go") sub->add_option("target", command->target, "Name of a hole of the plan")->required();
  sub->add_option("--socket", command->socket,
                  "The controller's Unix socket (default: $EDGEPOSE_SERVO_SOCKET, else " +
                      default_servo_socket().string() + ")");
  sub->add_option("--timeout", command->timeout, "[s] How long to wait for the answer (default 10)")
      ->check(CLI::Range(0.001, 3600.0));
  sub->add_flag("--json", command->as_json, "Print the controller's answer as JSON");
  sub->callback([command, name, done] {
    const json answer = command->call(name, name == "go" ? json{{"target", command->target}} : json());
    if (command->as_json) {
      std::cout << answer.dump(2, ' ', false, json::error_handler_t::replace) << '\n';
    } else if (name == "status") {
      print_status(answer);
    } else {
      std::cout << done << '\n';
    }
  });
}

}  // namespace

void add_client_commands(CLI::App& app) {
  add(app, "arm", "Set up the drives and put power on: then go is allowed", "armed");
  add(app, "go", "Move the tool to a hole: to its standoff, then along its axis to the touch",
      "on the way; edgepose-servo status shows how far");
  add(app, "stop", "Bring the arm to rest now. No emergency stop: use the one beside the arm",
      "the arm comes to rest");
  add(app, "reset", "Forget a stop, an arrival or a fault; arm comes next", "reset");
  add(app, "homed",
      "Say that drives which have booted by themselves, or have moved unseen, know their position", "noted");
  add(app, "status", "What the controller does", "");
}

}  // namespace edgepose
