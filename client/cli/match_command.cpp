#include "client/cli/match_command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/cli/exit_codes.h"
#include "client/cli/match_overlay.h"
#include "client/cli/match_report.h"
#include "client/cli/mesh_input.h"
#include "client/cli/model_input.h"
#include "client/cli/option_checks.h"
#include "client/cli/plan_report.h"
#include "client/cli/scene_input.h"
#include "common/error.h"
#include "common/naming.h"
#include "common/output_target.h"
#include "evaluation/deadline.h"
#include "settings/matcher_settings.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr const char* kMatchExamples = R"(Examples:
  edgepose match bolt.model --depth frame.png --intrinsics 600,600,319.5,239.5
  edgepose match bolt.model nut.model --depth 000003.png --intrinsics scene_camera.json --json
  edgepose match bolt.model --depth frame.png --intrinsics camera_info.yaml --overlay found.png
  edgepose match bolt.model --depth frame.png --intrinsics K.json --deadline-ms 50
  edgepose match bolt.model --cloud scan.pcd --unit m --viewpoint 0,0,0
  edgepose match vertebra.model --depth d.png --intrinsics K.json --plan drill_plan.json

With --deadline-ms each MODEL has that time for itself, all of the preprocessing included and reading files left
out; match.max_seconds of --config then means nothing. An answer that was cut short says so.

Exit code: 0 if at least one model was found, 1 if none was, 2 for bad input.)";

struct MatchCommand {
  std::vector<std::filesystem::path> models, meshes;
  LengthUnit cloud_unit = LengthUnit::kMillimetre, mesh_unit = LengthUnit::kMillimetre;
  SceneSource source;
  std::filesystem::path config, overlay, plan;
  bool as_json = false, paper_mode = false, any_size = false;
  std::optional<int> max_instances, threads;
  std::optional<double> accept_score, deadline_ms;

  void run() const;

 private:
  Settings settings() const;
  std::vector<std::filesystem::path> files() const;  ///< that are read
  std::vector<ModelInput> read_models(const TrainOptions& options) const;
  void print(const std::vector<NamedResult>& results, const std::optional<PlanReport>& targets,
             const SceneInput& scene, double preprocessing_seconds) const;
};

Settings MatchCommand::settings() const {
  Settings settings = config.empty() ? Settings{} : read_settings(config);
  if (paper_mode) settings.match.verification = Verification::kPaper;
  if (max_instances) settings.match.max_instances = *max_instances;
  settings.match.edge_score = true;  // one image, and somebody who reads the figures
  if (accept_score) settings.match.accept_score = static_cast<float>(*accept_score);
  if (threads) settings.train.threads = settings.scene.threads = settings.match.threads = *threads;
  return settings;
}

std::vector<ModelInput> MatchCommand::read_models(const TrainOptions& options) const {
  if (!meshes.empty() && meshes.size() != models.size()) {
    throw InputError::at("--mesh", "one mesh for each of the " + std::to_string(models.size()) + " models",
                         std::to_string(meshes.size()));
  }
  std::vector<ModelInput> inputs;
  for (size_t i = 0; i < models.size(); ++i) {
    inputs.push_back(load_or_train(models[i], mesh_unit, limits_for(any_size), options));
    if (!meshes.empty())
      inputs.back().mesh = read_sound_mesh(meshes[i], mesh_unit, limits_for(any_size)).mesh;
  }
  return inputs;
}

std::vector<std::filesystem::path> MatchCommand::files() const {
  std::vector<std::filesystem::path> list = {source.depth, source.cloud, source.intrinsics, config, plan};
  list.insert(list.end(), models.begin(), models.end());
  list.insert(list.end(), meshes.begin(), meshes.end());
  return list;
}

void MatchCommand::run() const {
  const Settings options = settings();
  if (!plan.empty() && models.size() != 1) {
    throw InputError::at("--plan", "one MODEL, the one that it was made for", std::to_string(models.size()));
  }
  if (!overlay.empty()) check_output(overlay, files());
  const std::optional<DrillPlan> drill_plan =
      plan.empty() ? std::nullopt : std::optional(read_drill_plan(plan));
  const SceneInput input = read_scene(source, cloud_unit);
  const std::vector<ModelInput> inputs = read_models(options.train);
  if (drill_plan) {
    check_drill_plan(*drill_plan, inputs.front().model.centre(), inputs.front().model.diameter(),
                     plan.string());
  }

  const Scene scene = prepare(input, options.scene);
  std::vector<MatchResult> answers;
  std::vector<const Model*> asked;
  const MatchOptions how =
      within_deadline(options.match, 1e-3 * deadline_ms.value_or(0), scene.preprocessing_seconds());
  for (const ModelInput& model : inputs) {
    answers.push_back(naming(model.file.string(), [&] { return match(scene, model.model, how); }));
    asked.push_back(&model.model);
  }
  resolve_conflicts(scene, asked, options.match, answers);
  std::vector<NamedResult> results;
  for (size_t i = 0; i < inputs.size(); ++i) {
    const Model& model = inputs[i].model;
    results.push_back({model.name(), inputs[i].file.string(), model.diameter(), model.centre(),
                       model.symmetries(), std::move(answers[i])});
  }

  if (!overlay.empty()) {
    write_match_overlay(overlay, input, inputs, results,
                        drill_plan ? overlay_targets(*drill_plan) : std::vector<OverlayTarget>{});
  }
  bool any_found = false;
  for (NamedResult& named : results) {
    named.result = in_frame(input.frame_T_camera, std::move(named.result));
    any_found = any_found || named.found();
  }
  std::optional<PlanReport> targets;
  if (drill_plan && any_found) targets = report_plan(*drill_plan, results.front());
  print(results, targets, input, scene.preprocessing_seconds());
  if (!any_found) exit_not_found();
}

void MatchCommand::print(const std::vector<NamedResult>& results, const std::optional<PlanReport>& targets,
                         const SceneInput& scene, double preprocessing_seconds) const {
  if (!as_json) {
    print_table(std::cout, results, scene.frame, preprocessing_seconds);
    if (targets) print_table(std::cout, *targets, scene.frame);
    if (!overlay.empty()) std::cout << "overlay: " << overlay.string() << '\n';
    return;
  }
  json models_found = json::array();
  for (const NamedResult& named : results) models_found.push_back(to_json(named, scene.frame));
  json report = {{"edgepose", EDGEPOSE_VERSION},
                 {"scene", scene.file},
                 {"frame", scene.frame},
                 {"preprocessing_seconds", preprocessing_seconds},
                 {"models", models_found}};
  if (targets) report["plan"] = to_json(*targets, scene.frame);
  print_json(std::cout, report);
}

}  // namespace

void add_match_command(CLI::App& app) {
  auto command = std::make_shared<MatchCommand>();
  CLI::App* match = app.add_subcommand("match", "Find models in a depth image or cloud");
  match->add_option("MODEL", command->models, "Trained models, or meshes to train on the fly")->required();
  add_scene_options(*match, command->source);
  add_unit_option(*match, "--unit", command->cloud_unit, "the cloud and its viewpoint");
  add_unit_option(*match, "--mesh-unit", command->mesh_unit, "meshes given as MODEL or --mesh");
  add_any_size_option(*match, command->any_size);
  match->add_flag("--json", command->as_json, "Print JSON (docs/match_json.md) instead of a table");
  add_output_option(*match, "--overlay", command->overlay,
                    "Write a picture of the found poses over the depth image");
  match
      ->add_option("--mesh", command->meshes,
                   "The models' meshes, in their order, for the overlay (default: the models' own outlines)")
      ->needs("--overlay");
  match->add_option("--plan", command->plan,
                    "Drill plan (JSON) whose targets are printed where they were found");
  match
      ->add_option("--max-instances", command->max_instances,
                   "Instances of each model to look for (default 1)")
      ->check(CLI::Range(1, 100));
  match->add_option("--accept", command->accept_score, "Score from which a pose counts as found")
      ->check(number_between(0, 1));
  add_deadline_option(*match, command->deadline_ms, "each model");
  match->add_flag("--paper-mode", command->paper_mode,
                  "Verify as the paper does: always answers with a pose");
  match->add_option("--config", command->config, "TOML file with any option (config/edgepose.toml)");
  match->add_option("--threads", command->threads, "Threads; 0 = all cores; never changes the result")
      ->check(CLI::Range(0, kMaxThreads));
  match->footer(kMatchExamples);
  match->callback([command] { command->run(); });
}

}  // namespace edgepose
