/// edgeposed: the daemon. Options, and what can go wrong at the start; everything else is server/service.
#include <CLI/CLI.hpp>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <new>

#include "common/command_line.h"
#include "common/error.h"
#include "common/keep_memory.h"
#include "server/service.h"
#include "server/training.h"

namespace edgepose {
namespace {

constexpr int kBadInput = 2;
constexpr const char* kExamples = R"(Examples:
  edgeposed                                  without a file all defaults stand
  edgeposed --config /etc/edgepose/edgeposed.toml
  edgeposed --config edgeposed.toml --check-config
  edgeposed --lcm-url 'udpm://239.255.76.67:7667?ttl=0' --state ./models --socket ./control.sock

Then, from another terminal: edgepose status, edgepose models add bolt.stl, edgepose watch.
SIGTERM ends it after the frame at hand; SIGHUP reads the configuration again.
Exit code: 0 ended, 2 could not start (one line on stderr says why).)";

struct Arguments {
  std::filesystem::path config;
  std::string lcm_url, state, socket;
  bool check_only = false;
};

ServiceOptions options_of(const Arguments& arguments) {
  ServiceOptions options =
      arguments.config.empty() ? ServiceOptions{} : read_service_options(arguments.config);
  if (!arguments.lcm_url.empty()) options.lcm_url = arguments.lcm_url;
  if (!arguments.state.empty()) options.state_folder = arguments.state;
  if (!arguments.socket.empty()) options.control_socket = arguments.socket;
  options.check("options");
  return options;
}

int run(int argc, char** argv) {
  CLI::App app{
      "edgeposed: keeps models loaded, takes depth frames over LCM, publishes poses and drill targets"};
  Arguments arguments;
  app.set_version_flag("--version", "edgeposed " EDGEPOSE_VERSION);
  app.add_option("--config", arguments.config, "TOML file (config/edgeposed.toml lists every key)");
  app.add_flag("--check-config", arguments.check_only, "Say whether the configuration is sound, and end");
  app.add_option("--lcm-url", arguments.lcm_url, "Instead of service.lcm_url");
  app.add_option("--state", arguments.state, "Instead of service.state_folder");
  app.add_option("--socket", arguments.socket, "Instead of service.control_socket");
  app.footer(kExamples);
  app.name("edgeposed");
  check_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(command_line_fault(app, error));
  }
  // Once: a daemon outlives the folder that it was started in.
  for (std::string* path : {&arguments.state, &arguments.socket})
    if (!path->empty()) *path = std::filesystem::absolute(*path);
  if (!arguments.config.empty()) arguments.config = std::filesystem::absolute(arguments.config);
  const ServiceOptions options = options_of(arguments);
  if (arguments.check_only) {
    std::cout << (arguments.config.empty() ? "the defaults" : arguments.config.string()) << ": sound\n";
    return 0;
  }
  run_service(options, arguments.config, [&] { return options_of(arguments); });
  return 0;
}

}  // namespace
}  // namespace edgepose

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], edgepose::kTrainingChild) == 0) return edgepose::run_training_child();
  edgepose::keep_freed_memory();
  try {
    return edgepose::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "edgeposed: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "edgeposed: " << edgepose::one_line(error.what()) << '\n';
  }
  return edgepose::kBadInput;
}
