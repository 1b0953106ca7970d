#include "demo/demo_report.h"

#include <numbers>

#include "arm/rigid_motion.h"
#include "evaluation/table.h"
#include "files/whole_file.h"
#include "render/overlay.h"

namespace edgepose {
namespace {

constexpr size_t kMaxRecordBytes = size_t{1} << 30;
constexpr int kPictureWidth = 960;  // [pixels]

/// What the programs wrote, as it lies in the temporary folder.
constexpr const char* kRecords[] = {"arm.csv",         "truth.csv",          "bus.pcap",
                                    "edgeposed.log",   "edgepose-sim.log",   "edgepose-servo.log",
                                    "taught.json",     "told/hand-eye.json", "told/tool.json",
                                    "told/camera.json"};

std::string picture(const DemoRun& run, const std::optional<SeenFrame>& seen, const std::string& name,
                    FileGroup& files) {
  if (!seen) return "No frame of the " + name + ": the service never found the model.\n\n";
  const DrillTarget& target = run.cell.find_target(run.cell.target);
  OverlayPose pose;
  pose.mesh = &run.cell.model;
  pose.camera_T_model = seen->camera_T_model;
  pose.targets = {{target.name, target.entry, target.axis, target.depth, target.diameter}};
  OverlayOptions options;
  options.width = kPictureWidth;
  const RgbImage image = draw_overlay(seen->frame.image, seen->frame.intrinsics, {pose}, options);
  files.add(run.options.output / (name + ".png"), encode_png(image));
  return "The frame at the " + name + ", as it was sent, and the model where the service found it, score " +
         fixed(seen->score, 2) + ":\n\n![The " + name + "](" + name + ".png)\n\n";
}

std::string plots(const DemoRun& run, FileGroup& files, std::string& warning) {
  if (!gnuplot_available()) {
    warning = "no plots, because the program gnuplot is missing; install gnuplot-nox to get them";
    return "No plots: the program gnuplot is missing.\n";
  }
  std::string markdown;
  for (const Figure& figure : demo_figures(run)) {
    draw(figure, run.options.output, files);
    markdown += "![" + figure.title + "](" + figure.file + ".png)\n\n";
  }
  return markdown;
}

std::string goal_text(const DemoRun& run) {
  switch (run.options.goal) {
    case DemoGoal::kCalibrations:
      return "From the hand-eye and tool calibrations as told: their errors stay in the goal "
             "(docs/servoing.md).\n";
    case DemoGoal::kExact:
      return "Exact: the controller was given the simulator's true place of the tool before the camera.\n";
    case DemoGoal::kTaught:
      break;
  }
  Table table({"place", "poses", "residual mm", "residual deg", "noise mm", "noise deg"});
  for (const TaughtTool::Residual& one : run.taught->taught.residuals)
    table.add({one.name, std::to_string(one.poses), fixed(1e3 * one.translation, 3),
               fixed(180 / std::numbers::pi * one.rotation, 3), fixed(1e3 * one.noise.translation, 3),
               fixed(180 / std::numbers::pi * one.noise.rotation, 3)});
  return "Taught at places of the model other than the hole, before the run, in simulated time inside "
         "edgepose-servo demo: the simulator put the true tool there without error (nobody led the arm there "
         "over "
         "the bus), its camera took noisy frames, and the service's own code found the model in them.\n\n" +
         table.markdown();
}

std::string measured_text(const DemoRun& run) {
  const auto number = [&](const char* key, double factor, int decimals) {
    const auto found = run.controller.find(key);
    return found != run.controller.end() && found->is_number()
               ? fixed(factor * found->get<double>(), decimals)
               : std::string("-");
  };
  Table table({"what", "value"});
  table.add({"depth frames heard on LCM", std::to_string(run.frames)});
  table.add({"answers of the service", std::to_string(run.answers)});
  table.add({"of them with the model", std::to_string(run.found)});
  table.add({"poses taken by the controller", number("poses_taken", 1, 0)});
  table.add({"poses refused by it", number("poses_refused", 1, 0)});
  table.add({"cycle of 5 ms, late p99.9, us", number("late_p99.9_s", 1e6, 0)});
  table.add({"cycles left out", number("cycles_missed", 1, 0)});
  return table.markdown();
}

std::string faults_text(const DemoRun& run) {
  if (run.faults.empty()) return "";
  std::string text = "\n## Faults\n\nAfter each the arm was reset, armed and set going again:\n\n";
  for (const std::string& fault : run.faults) text += "- " + harmless_text(fault) + "\n";
  return text;
}

std::string report_text(const DemoRun& run, const std::string& pictures, const std::string& figures) {
  const TruthPoint& end = run.track.truth.back();
  return "# The arm, without hardware\n\n    " + harmless_text(run.command) + "\n\n**" + verdict(run) +
         "**\n\n- true tip error at the end: " + fixed(1e3 * end.distance(), 3) +
         " mm\n- true axis error at the end: " + fixed(180 / std::numbers::pi * end.angle, 3) +
         " degrees\n- " + run.versions +
         "\n\nService, simulator and controller ran as processes of their own: depth frames over LCM, the "
         "arm over "
         "CANopen on a Unix bus.\n\n## Steps\n\nThe true errors are against the entry of the hole, which the "
         "arm first approaches to 40 mm; the controller's own are against where the tool is to be at that "
         "moment, and end when it has converged.\n\n" +
         steps_table(run.track) +
         "\n## Seen\n\nDepth: near warm, far blue, black not measured (most of the drill is nearer than the "
         "camera measures).\n\n" +
         pictures + "## Plots\n\n" + figures + "\n## What the controller was told wrong\n\n" +
         told_table(run.cell, run.told) + faults_text(run) + "\n## The goal\n\n" + goal_text(run) +
         "\n## Counted\n\n" + measured_text(run) +
         "\nrecord/ has the controller's cycles (arm.csv), the truth (truth.csv), the bus (bus.pcap, for "
         "Wireshark), the calibrations and the programs' logs.\n";
}

}  // namespace

std::string write_demo_report(const DemoRun& run, const std::filesystem::path& source) {
  FileGroup files;
  std::string warning;
  const std::filesystem::path& folder = run.options.output;
  files.make_folder(folder);
  files.make_folder(folder / "record");
  const std::string pictures = picture(run, run.first, "start", files) + picture(run, run.last, "end", files);
  const std::string figures = plots(run, files, warning);
  for (const char* name : kRecords)
    if (std::error_code ignored; std::filesystem::is_regular_file(source / name, ignored) &&
                                 std::filesystem::file_size(source / name, ignored) > 0)
      files.add(folder / "record" / std::filesystem::path(name).filename(),
                read_whole_file(source / name, "a record", kMaxRecordBytes));
  files.add(folder / "report.md", report_text(run, pictures, figures));
  files.commit();
  return warning;
}

}  // namespace edgepose
