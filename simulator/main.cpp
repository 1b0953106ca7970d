/// edgepose-sim: the world without hardware. Options, and what can go wrong at the start; everything else is
/// simulator/simulation.
#include <CLI/CLI.hpp>
#include <iostream>
#include <new>

#include "common/command_line.h"
#include "common/error.h"
#include "simulator/simulation.h"

namespace edgepose {
namespace {

constexpr int kBadInput = 2;
constexpr const char* kExamples = R"(Examples:
  edgepose-sim --model phantom.ply --plan drill_plan.json
  edgepose-sim --model phantom.ply --plan drill_plan.json --publish poses --told told/ --control sim.sock
  edgepose-sim --model phantom.ply --plan drill_plan.json --bus vcan0 --seed 7 --truth truth.csv

A controller joins the bus (unix:/tmp/edgepose-sim.sock), reads what it is told from the folder of --told, and takes
poses from edgeposed, which finds the bone in the depth frames; or from here, with --publish poses.
The truth goes to --truth and to the channel EDGEPOSE_TRUTH: nobody who controls the arm may read it.
SIGTERM ends it. Exit code: 0 ended, 2 could not start (one line on stderr says why).)";

void add_cell_options(CLI::App& app, SimulationOptions& options) {
  app.add_option("--model", options.cell.model, "Mesh of the bone, millimetres")->required();
  app.add_option("--plan", options.cell.plan, "Drill plan for it")->required();
  app.add_option("--target", options.cell.target, "Hole of the plan (default: its first)");
  app.add_option("--seed", options.seed, "Of start, told and sensor noise")->capture_default_str();
  choose<SimStart>(app.add_option("--start-at", options.start,
                                  "random: within 100 mm and 20 degrees of the standoff; or standoff"),
                   {{"random", SimStart::kRandom}, {"standoff", SimStart::kStandoff}});
}

void add_saying_options(CLI::App& app, SimulationOptions& options) {
  app.add_option("--lcm-url", options.lcm_url, "Where messages go (udpm://...)");
  choose<SimPublish>(
      app.add_option("--publish", options.publish,
                     "depth: frames; poses: what a pose service would say; or none"),
      {{"depth", SimPublish::kDepth}, {"poses", SimPublish::kPoses}, {"none", SimPublish::kNothing}});
  app.add_option("--rate", options.rate, "Frames or poses a second (default: 10 or 30)");
  app.add_option("--camera-name", options.camera, "Name of the camera")->capture_default_str();
  app.add_option("--sensor", options.sensor,
                 "kinect_narrow, time_of_flight, structured_light, laser or ideal")
      ->capture_default_str();
  app.add_option("--key", options.key, "Key file: poses are signed with it");
}

int run(int argc, char** argv) {
  CLI::App app{"edgepose-sim: six drives on a CAN bus, the arm that they move, and the depth camera on it"};
  SimulationOptions options;
  app.set_version_flag("--version", "edgepose-sim " EDGEPOSE_VERSION);
  add_cell_options(app, options);
  app.add_option("--bus", options.bus, "unix:/path, which is made, or a CAN interface")
      ->capture_default_str();
  add_saying_options(app, options);
  choose<bool>(
      app.add_option("--noise", options.noise, "How wrong the controller is told to be: paper or none"),
      {{"paper", true}, {"none", false}});
  app.add_option("--told", options.told, "Folder for hand-eye.json, tool.json and camera.json, as told");
  app.add_option("--truth", options.truth, "CSV file for the truth, one line a millisecond");
  app.add_option("--control", options.control, "Unix socket for commands (docs/simulator.md)");
  app.add_option("--duplicate-node", options.duplicate_node, "Two drives have this number, 1 to 6");
  app.add_option("--absent-node", options.absent_node, "This drive is not there, 1 to 6");
  app.add_option("--foreign-node", options.foreign_node, "This drive says it is another make's, 1 to 6");
  app.add_flag(
      "--keep-awake", options.keep_awake,
      "The processors never sleep: time is kept on a virtual machine too, at the power of one that works");
  app.add_flag("--ready", options.ready, "Print READY ... on stdout when everything listens");
  app.footer(kExamples);
  app.name("edgepose-sim");
  check_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);
    throw InputError(command_line_fault(app, error));
  }
  run_simulation(options);
  return 0;
}

}  // namespace
}  // namespace edgepose

int main(int argc, char** argv) {
  try {
    return edgepose::run(argc, argv);
  } catch (const std::bad_alloc&) {
    std::cerr << "edgepose-sim: out of memory\n";
  } catch (const std::exception& error) {
    std::cerr << "edgepose-sim: " << edgepose::one_line(error.what()) << '\n';
  }
  return edgepose::kBadInput;
}
