#include "client/cli/detect_command.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/cli/control_options.h"
#include "client/cli/exit_codes.h"
#include "client/cli/match_report.h"
#include "client/cli/option_checks.h"
#include "client/cli/progress_bar.h"
#include "client/cli/text.h"
#include "common/error.h"
#include "files/depth_file.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr const char* kDetectExamples = R"(Examples:
  edgepose detect                                   # the active models in the last frame
  edgepose detect --model l3 --depth frame.png --intrinsics 600,600,319.5,239.5
  edgepose detect --depth 000003.png --intrinsics scene_camera.json --json

Exit code: 0 if at least one model was found, 1 if none was, 2 for bad input or without a daemon.)";

struct DetectCommand {
  ControlOptions control;
  std::vector<std::string> models;
  std::filesystem::path depth;
  std::string intrinsics;
  double depth_scale = 0;  // [mm per unit]

  json params() const;
  void run() const;
};

std::string absolute_if_file(const std::string& text) {
  std::error_code failure;
  const auto path = std::filesystem::canonical(text, failure);
  return failure ? text : path.string();
}

json DetectCommand::params() const {
  json params = json::object();
  if (!models.empty()) params["models"] = models;
  if (depth.empty()) return params;
  if (intrinsics.empty()) throw InputError("--depth needs --intrinsics: fx,fy,cx,cy or a camera's file");
  std::error_code failure;
  if (!std::filesystem::is_regular_file(depth, failure))
    throw InputError::at(depth.string(), "a depth image", failure ? failure.message() : "no regular file");
  params["depth"] = absolute_if_file(depth.string());
  params["intrinsics"] = absolute_if_file(intrinsics);
  if (depth_scale > 0) params["depth_scale"] = 1e-3 * depth_scale;
  return params;
}

bool is_found(const json& model) { return member(model, "found") == true; }

/// Millimetres; the whole of it is in the JSON.
void print_detections(std::ostream& out, const json& report) {
  const json& models = member(report, "models");
  if (!models.is_array() || models.empty()) {
    out << "no model is active; edgepose models activate NAME changes that\n";
    return;
  }
  out << formatted("%-20s %-5s %26s  %5s\n", "model", "found", "position in camera [mm]", "score");
  for (const json& model : models) {
    const std::string name = text_of(model, "model");
    const json& detections = member(model, "detections");
    for (size_t i = 0; detections.is_array() && i < detections.size(); ++i) {
      const json& t = member(detections[i], "translation_m");
      const auto at = [&](size_t axis) {
        return t.is_array() && t.size() == 3 && t[axis].is_number() ? 1e3 * t[axis].get<double>() : 0.0;
      };
      out << formatted("%-20.20s %-5.5s %8.2f %8.2f %8.2f  %5s\n", name.c_str(),
                       text_of(detections[i], "accepted").c_str(), rounded(at(0), 2), rounded(at(1), 2),
                       rounded(at(2), 2), number_of(detections[i], "score", 1, 2).c_str());
    }
    if (member(model, "cut_short") == true)
      out << formatted("%-20s cut short: the time was over before the search was\n", "");
    if (!is_found(model))
      out << formatted("%-20.20s not found: ", name.c_str()) << text_of(model, "reason") << '\n';
  }
}

void DetectCommand::run() const {
  const auto elapsed = elapsed_time("detecting");
  const json report = control.call("detect", params(), elapsed);
  elapsed(-1);
  if (control.as_json)
    print_json(std::cout, report);
  else
    print_detections(std::cout, report);
  const json& found = member(report, "models");
  if (!found.is_array() || std::none_of(found.begin(), found.end(), is_found)) exit_not_found();
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto command = std::make_shared<DetectCommand>();
  CLI::App* detect = app.add_subcommand("detect", "Have the daemon look for its models once");
  detect->add_option("--model", command->models, "Only these models (default: the active ones)");
  auto* depth = detect->add_option("--depth", command->depth, "Depth image (default: the last frame)");
  detect->add_option("--intrinsics", command->intrinsics, "Its camera: fx,fy,cx,cy or a file")->needs(depth);
  detect
      ->add_option("--depth-scale", command->depth_scale,
                   "Millimetres per unit of the depth image (default: as the camera's file says, else 1)")
      ->check(number_between(1e3 * kMinDepthScale, 1e3 * kMaxDepthScale))
      ->needs(depth);
  command->control.add_to(*detect, 60);
  detect->footer(kDetectExamples);
  detect->callback([command] { command->run(); });
}

}  // namespace edgepose
