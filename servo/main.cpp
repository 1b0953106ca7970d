/// edgepose-servo: the arm's controller, and the commands to it.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iostream>
#include <memory>

#include "common/command_line.h"
#include "common/error.h"
#include "controller/controller.h"
#include "servo/arm_commands.h"
#include "servo/demo_command.h"
#include "servo/experiment_command.h"

namespace edgepose {
namespace {

constexpr int kBadInput = 2;
constexpr const char* kExamples = R"(Examples:
  edgepose-servo demo                                    everything without hardware, to a report
  edgepose-servo run --config edgepose-servo.toml        the controller; nothing moves until it is told to
  edgepose-servo arm                                     from another terminal
  edgepose-servo go left_pedicle_screw
  edgepose-servo status
  edgepose-servo stop

A software stop is no certified emergency stop.
Exit code: 0 done, 1 not converged or cut short, 2 refused or could not start (one line on stderr says why).)";

constexpr const char* kRunExamples = R"(Examples:
  edgepose-servo run --config /etc/edgepose/edgepose-servo.toml
  edgepose-servo run --bus can0 --model l3 --hand-eye hand-eye.json --tool drill.json --taught taught.json
  edgepose-servo run --bus unix:/tmp/arm.bus --model phantom --hand-eye told/hand-eye.json --tool told/tool.json \
                     --log arm.csv --capture arm.pcap      with edgepose-sim

SIGTERM and Ctrl-C bring the arm to rest, take its power off and end the program.)";

struct RunCommand {
  std::filesystem::path config;
  ControllerOptions given;
  bool check_only = false;

  std::vector<std::pair<std::string, CLI::Option*>> on_command_line = {};  ///< by key

  ControllerOptions options() {
    ControllerOptions all = config.empty() ? ControllerOptions{} : read_controller_options(config);
    std::vector<SettingKey> to = controller_keys(all), from = controller_keys(given);
    for (size_t i = 0; i < to.size(); ++i)
      for (const auto& [key, option] : on_command_line)
        if (key == to[i].path && option->count() > 0)
          std::visit([&](auto* field) { *field = *std::get<std::decay_t<decltype(field)>>(from[i].field); },
                     to[i].field);
    all.check(config.empty() ? "options" : config);
    return all;
  }
};

void add_run_command(CLI::App& app) {
  auto command = std::make_shared<RunCommand>();
  ControllerOptions& o = command->given;
  CLI::App* run = app.add_subcommand("run", "Run the controller");
  const auto add = [&](const char* name, const std::string& key, std::string& field, const char* help) {
    command->on_command_line.emplace_back("controller." + key, run->add_option(name, field, help));
  };
  run->add_option("--config", command->config, "TOML file (config/edgepose-servo.toml lists every key)");
  run->add_flag("--check-config", command->check_only, "Say whether the configuration is sound, and end");
  add("--bus", "bus", o.bus, "CAN interface, unix:/path or pcap:/file (default can0)");
  add("--lcm-url", "lcm_url", o.lcm_url, "Where the pose service publishes");
  add("--model", "model", o.model, "Name of the model in the pose service");
  add("--camera", "camera", o.camera, "Only frames of this camera");
  add("--hand-eye", "hand_eye", o.hand_eye, "File of edgepose calibrate hand-eye");
  add("--tool", "tool", o.tool, "File that says where the tool is on the flange");
  add("--taught", "taught", o.taught, "File of edgepose teach: without it no set-up reaches 1 mm");
  add("--key", "key_file", o.key_file, "Only messages signed with this key count (edgepose keygen)");
  add("--socket", "control_socket", o.control_socket, "Unix socket for commands");
  add("--log", "log", o.log, "Write a line of CSV for each cycle");
  add("--capture", "capture", o.capture, "Write every frame of the bus, for Wireshark (pcap)");
  run->footer(kRunExamples);
  run->callback([command] {
    const ControllerOptions options = command->options();
    if (command->check_only) {
      std::cout << (command->config.empty() ? "the options" : command->config.string()) << ": sound\n";
      return;
    }
    run_controller(options);
  });
}

int run(int argc, char** argv) {
  CLI::App app{
      "edgepose-servo: brings the tool of a six-axis arm to a planned hole, by what the pose service sees"};
  app.set_version_flag("--version", "edgepose-servo " EDGEPOSE_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  add_run_command(app);
  add_client_commands(app);
  add_experiment_command(app);
  add_demo_command(app);
  app.name("edgepose-servo");
  check_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(command_line_fault(app, error));
  }
  return 0;
}

}  // namespace
}  // namespace edgepose

int main(int argc, char** argv) {
  try {
    return edgepose::run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "edgepose-servo: " << edgepose::one_line(error.what()) << '\n';
  }
  return edgepose::kBadInput;
}
