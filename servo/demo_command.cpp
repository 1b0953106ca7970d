#include "servo/demo_command.h"

#include <iostream>
#include <memory>

#include "client/service/stop_signals.h"
#include "common/command_line.h"
#include "common/error.h"
#include "demo/demo.h"
#include "demo/demo_processes.h"

namespace edgepose {
namespace {

constexpr const char* kDemoExamples = R"(Examples:
  edgepose-servo demo                                    the phantom; the report goes to ./edgepose-demo
  edgepose-servo demo --seed 7 -o seven --goal calibrations
  edgepose-servo demo --mesh l3.ply --plan l3_plan.json --target left -o l3

Starts edgeposed, edgepose-sim and edgepose-servo run, those that lie beside this program, on a multicast port and
sockets of their own; moves the arm from a random start to the hole; ends them all, and writes report.md with the
table of steps, plots and pictures. About a minute. Ctrl-C ends everything.
Exit code: 0 converged, 1 not, or stopped by Ctrl-C, 2 bad input, or one of the programs failed (one line on stderr
says why).)";

struct DemoCommand {
  DemoOptions options;

  void run() const {
    const std::string command = "edgepose-servo demo --seed " + std::to_string(options.seed) + " --noise " +
                                (options.noise ? "paper" : "none") + " --goal " + goal_name();
    const StopSignals signals;
    try {
      const DemoEnd end = run_demo(options, command, signals.token(),
                                   [](const std::string& line) { std::cerr << line << '\n'; });
      if (!end.warning.empty()) std::cerr << "edgepose-servo: " << end.warning << '\n';
      std::cout << end.verdict << "\nreport: " << (options.output / "report.md").string() << '\n';
      if (!end.converged) throw CLI::RuntimeError(1);
    } catch (const DemoStopped&) {
      std::cerr << "edgepose-servo: stopped; nothing is written\n";
      throw CLI::RuntimeError(1);
    }
  }
  std::string goal_name() const {
    return options.goal == DemoGoal::kTaught  ? "taught"
           : options.goal == DemoGoal::kExact ? "exact"
                                              : "calibrations";
  }
};

}  // namespace

void add_demo_command(CLI::App& app) {
  auto command = std::make_shared<DemoCommand>();
  DemoOptions& o = command->options;
  CLI::App* demo = app.add_subcommand(
      "demo", "Everything without hardware: service, simulator and controller, to a report");
  demo->add_option("--mesh", o.cell.model, "Mesh of the bone, millimetres (default: the phantom)");
  demo->add_option("--plan", o.cell.plan, "Drill plan for it");
  demo->add_option("--target", o.cell.target, "Hole of the plan (default: its first)");
  demo->add_option("-o,--output", o.output, "Folder for the report")->capture_default_str();
  demo->add_option("--seed", o.seed, "Of start, what is told, and the camera's noise")->capture_default_str();
  choose<bool>(
      demo->add_option("--noise", o.noise, "How wrong the controller is told to be: paper (default) or none"),
      {{"paper", true}, {"none", false}});
  choose<DemoGoal>(
      demo->add_option("--goal", o.goal, "taught (default), calibrations or exact (docs/servoing.md)"),
      {{"taught", DemoGoal::kTaught},
       {"calibrations", DemoGoal::kCalibrations},
       {"exact", DemoGoal::kExact}});
  demo->add_option("--taught-poses", o.taught_poses, "Poses at each of the five places")
      ->capture_default_str();
  demo->add_option("--seconds", o.seconds, "[s] that the arm has")->capture_default_str();
  demo->footer(kDemoExamples);
  demo->callback([command] { command->run(); });
}

}  // namespace edgepose
