#include "client/cli/models_command.h"

#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/cli/control_options.h"
#include "client/cli/match_report.h"
#include "client/cli/mesh_input.h"
#include "client/cli/models_report.h"
#include "client/cli/progress_bar.h"
#include "common/error.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr const char* kModelsExamples = R"(Examples:
  edgepose models add l3.stl --plan l3_screws.json     # trains it; the daemon looks for it from then on
  edgepose models add bolt.model --name bolt_m8 --replace
  edgepose models list
  edgepose models deactivate bolt_m8
  edgepose models remove bolt_m8 --key /etc/edgepose/key

Exit code: 0 if it is done, 2 if not; one line on stderr says why.)";

struct NamedModel {
  ControlOptions control;
  std::string name;
};

struct AddedModel {
  ControlOptions control;
  std::filesystem::path file, plan;
  std::string name;
  LengthUnit unit = LengthUnit::kMillimetre;
  bool any_size = false, replace = false, inactive = false;

  json params() const;
  void run() const;
};

/// The daemon reads it, from its own folder.
std::string absolute_file(const std::filesystem::path& path, const std::string& what) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(path, failure))
    throw InputError::at(path.string(), what, failure ? failure.message() : "no regular file");
  return std::filesystem::canonical(path, failure).string();
}

json AddedModel::params() const {
  json params = {{is_mesh_file(file) ? "mesh" : "model", absolute_file(file, "a mesh or a trained model")},
                 {"unit", unit == LengthUnit::kMetre ? "m" : "mm"},
                 {"any_size", any_size},
                 {"activate", !inactive},
                 {"replace", replace}};
  if (!name.empty()) params["name"] = name;
  if (!plan.empty()) params["plan"] = absolute_file(plan, "a drill plan");
  return params;
}

void AddedModel::run() const {
  const auto elapsed = elapsed_time("training " + file.filename().string());
  const json model = control.call("models.register", params(), elapsed);
  elapsed(-1);
  if (control.as_json) return print_json(std::cout, model);
  print_model(std::cout, model);
}

void list(const ControlOptions& control) {
  const json models = control.call("models.list", nullptr);
  if (control.as_json) return print_json(std::cout, models);
  print_models(std::cout, models);
}

void remove(const NamedModel& model) {
  const json removed = model.control.call("models.unregister", {{"name", model.name}});
  if (model.control.as_json) return print_json(std::cout, removed);
  std::cout << "removed: " << text_of(removed, "name") << '\n';
}

void show(const NamedModel& wanted, const std::string& method, const json& params) {
  const json model = wanted.control.call(method, params);
  if (wanted.control.as_json) return print_json(std::cout, model);
  print_model(std::cout, model);
}

/// Adds a sub-command about one model.
template <class Run>
void add_named(CLI::App& models, const std::string& command, const std::string& description, Run run) {
  auto model = std::make_shared<NamedModel>();
  CLI::App* sub = models.add_subcommand(command, description);
  sub->add_option("NAME", model->name, "The model's name")->required();
  model->control.add_to(*sub);
  sub->callback([model, run] { run(*model); });
}

void add_add(CLI::App& models) {
  constexpr double kLongestTraining = 3600;  // [s]; the daemon has a limit of its own
  auto added = std::make_shared<AddedModel>();
  CLI::App* add = models.add_subcommand("add", "Train a mesh, or take a trained model, and look for it");
  add->add_option("FILE", added->file, "Mesh (PLY, STL, OBJ, PCD) or trained model")->required();
  add->add_option("--name", added->name, "Name (default: the file's)");
  add->add_option("--plan", added->plan, "Drill plan (JSON) whose targets are sent where it is found");
  add_unit_option(*add, "--unit", added->unit, "the mesh");
  add_any_size_option(*add, added->any_size);
  add->add_flag("--replace", added->replace, "Replace a model of this name");
  add->add_flag("--inactive", added->inactive, "Only keep it; models activate makes the daemon look for it");
  added->control.add_to(*add, kLongestTraining);
  add->callback([added] { added->run(); });
}

}  // namespace

void add_models_command(CLI::App& app) {
  CLI::App* models = app.add_subcommand("models", "The models that the daemon looks for");
  models->require_subcommand(1);
  models->footer(kModelsExamples);
  auto control = std::make_shared<ControlOptions>();
  CLI::App* all = models->add_subcommand("list", "All models");
  control->add_to(*all);
  all->callback([control] { list(*control); });
  add_named(*models, "show", "Everything about one", [](const NamedModel& model) {
    show(model, "models.get", {{"name", model.name}});
  });
  add_add(*models);
  add_named(*models, "remove", "Forget one", remove);
  add_named(*models, "activate", "Look for one", [](const NamedModel& model) {
    show(model, "models.activate", {{"name", model.name}, {"active", true}});
  });
  add_named(*models, "deactivate", "Keep one, but do not look for it", [](const NamedModel& model) {
    show(model, "models.activate", {{"name", model.name}, {"active", false}});
  });
}

}  // namespace edgepose
