#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "calibration/teach_file.h"
#include "demo/demo_options.h"
#include "demo/frame_recorder.h"
#include "demo/run_track.h"
#include "evaluation/plot.h"
#include "simulator/told.h"

namespace edgepose {

/// All that is known of one run.
struct DemoRun {
  const DemoOptions& options;
  const WorkCell& cell;
  const ToldEquipment& told;
  std::string state, fault;          ///< of the controller at the end
  std::optional<TaughtFile> taught;  ///< or the exact goal
  RunTrack track;
  std::optional<SeenFrame> first, last;
  int64_t frames = 0, answers = 0, found = 0;  ///< heard of the simulator, of the service, with the model
  std::vector<std::string> faults;             ///< after which the arm was set going again
  nlohmann::json controller;                   ///< its last status
  std::string versions, command;

  bool converged() const { return state == "converged"; }
};

/// One line: where it ended, by the truth.
std::string verdict(const DemoRun& run);

/// Every two seconds: true and believed errors.
std::string steps_table(const RunTrack& track);
/// What the controller was told, less the truth.
std::string told_table(const WorkCell& cell, const ToldEquipment& told);

/// The camera's path, feature errors, velocities, true errors.
std::vector<Figure> demo_figures(const DemoRun& run);

/// Writes report.md with its plots and pictures, and in record/ what the programs wrote (files of `source`),
/// into the options' output folder: all or nothing. Returns a warning (one line), or nothing. Throws
/// InputError.
std::string write_demo_report(const DemoRun& run, const std::filesystem::path& source);

}  // namespace edgepose
