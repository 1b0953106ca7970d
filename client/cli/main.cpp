/// edgepose: finds an object's 6D pose in a depth image. One file `<name>_command` for each command.
#include <fcntl.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "client/cli/calibrate_command.h"
#include "client/cli/compare_command.h"
#include "client/cli/detect_command.h"
#include "client/cli/eval_command.h"
#include "client/cli/exit_codes.h"
#include "client/cli/info_command.h"
#include "client/cli/keygen_command.h"
#include "client/cli/match_command.h"
#include "client/cli/merge_command.h"
#include "client/cli/models_command.h"
#include "client/cli/record_command.h"
#include "client/cli/render_command.h"
#include "client/cli/replay_command.h"
#include "client/cli/send_command.h"
#include "client/cli/status_command.h"
#include "client/cli/study_command.h"
#include "client/cli/train_command.h"
#include "client/cli/watch_command.h"
#include "common/command_line.h"
#include "common/error.h"
#include "common/keep_memory.h"
#include "common/nearest_word.h"
#include "common/temporary_file.h"

namespace edgepose {
namespace {

constexpr const char* kExamples = R"(Examples:
  edgepose train bolt.ply -o bolt.model
  edgepose match bolt.model --depth frame.png --intrinsics 600,600,320,240
  edgepose match bolt.model --depth frame.png --intrinsics scene_camera.json --overlay found.png --json
  edgepose models add bolt.ply && edgepose send frames/ --intrinsics camera_info.yaml    # with edgeposed running
  edgepose watch
  edgepose COMMAND --help

Exit code: 0 found or done, 1 not found, 2 bad input (one line on stderr says what).)";

/// One line for the person at the terminal, whatever the exception's text looks like.
int report_bad_input(const std::string& message) {
  std::cerr << "edgepose: " << one_line(message) << std::endl;
  return kExitBadInput;
}

/// CLI11 would only say that a command is missing.
void check_command(const CLI::App& app, const std::string& word) {
  if (word.starts_with("-")) return;
  std::vector<std::string> known;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (command->get_name() == word) return;
    known.push_back(command->get_name());
  }
  throw InputError("no command is called '" + word + "'; did you mean " + nearest_word(word, known) +
                   "? (edgepose --help shows all)");
}

void add_commands(CLI::App& app) {
  app.name("edgepose");
  app.set_version_flag("--version", "edgepose " EDGEPOSE_VERSION);
  app.require_subcommand(1);
  app.footer(kExamples);
  add_train_command(app);
  add_info_command(app);
  add_match_command(app);
  add_eval_command(app);
  add_merge_command(app);
  add_study_command(app);
  add_render_command(app);
  add_keygen_command(app);
  add_models_command(app);
  add_status_command(app);
  add_detect_command(app);
  add_send_command(app);
  add_watch_command(app);
  add_record_command(app);
  add_replay_command(app);
  add_compare_command(app);
  add_calibrate_command(app);
  add_teach_command(app);
  check_values(app);
}

int parse_and_run(CLI::App& app, int argc, char** argv) {
  try {
    if (argc > 1) check_command(app, argv[1]);
    app.parse(argc, argv);
    return kExitFound;
  } catch (const CLI::RuntimeError& ended) {
    return ended.get_exit_code();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return report_bad_input(command_line_fault(app, error));
  }
}

/// "Found" or "not found" is worth nothing if what was printed is lost.
int unless_output_was_lost(int code) {
  if (code == kExitBadInput || std::cout.flush()) return code;
  return report_bad_input("standard output: cannot write; is the disk full, or the output closed?");
}

/// Where the caller has closed a standard stream, the next file to be opened would take its number, and what
/// is printed would end up in that file. What stands in cannot be written to, so the loss is noticed.
void occupy_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && open("/dev/null", O_RDONLY) < 0) std::abort();
}

}  // namespace
}  // namespace edgepose

int main(int argc, char** argv) {
  edgepose::keep_freed_memory();
  std::signal(SIGXFSZ, SIG_IGN);  // a file at its limit is an error of the write, as a full disk
  edgepose::occupy_standard_streams();
  edgepose::remove_temporary_files_on_signals();
  try {
    CLI::App app{"edgepose: finds an object's 6D pose in a depth image by edge-enhanced point pair features"};
    edgepose::add_commands(app);
    return edgepose::unless_output_was_lost(edgepose::parse_and_run(app, argc, argv));
  } catch (const std::bad_alloc&) {
    return edgepose::report_bad_input("out of memory");
  } catch (const std::exception& error) {
    return edgepose::report_bad_input(error.what());
  }
}
