#include "client/cli/info_command.h"

#include <filesystem>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "client/cli/expected_time.h"
#include "client/cli/match_report.h"
#include "client/cli/mesh_input.h"
#include "client/cli/model_input.h"
#include "client/cli/text.h"
#include "files/model_file.h"

namespace edgepose {
namespace {

using nlohmann::json;

constexpr const char* kInfoExamples = R"(Examples:
  edgepose info bolt.model
  edgepose info bolt.model --json
  edgepose info bolt.stl --unit mm      (is the mesh sound, before it is trained?))";

struct InfoCommand {
  std::filesystem::path file;
  LengthUnit unit = LengthUnit::kMillimetre;
  bool as_json = false, any_size = false;

  void run() const { is_mesh_file(file) ? show_mesh() : show_model(); }

 private:
  void show_mesh() const;
  void show_model() const;
};

json to_json(const MeshHealth& health) {
  return {{"vertices", health.vertices},
          {"triangles", health.triangles},
          {"is_cloud", health.is_cloud},
          {"diameter_m", health.diameter},
          {"closed", health.closed()},
          {"inverted", health.inverted},
          {"parts", health.parts},
          {"open_edges", health.open_edges},
          {"non_manifold_edges", health.non_manifold_edges},
          {"degenerate_triangles", health.degenerate_triangles},
          {"non_finite_vertices", health.non_finite_vertices},
          {"mended", health.mended},
          {"warnings", health.warnings}};
}

void InfoCommand::show_mesh() const {
  const MeshHealth health = read_sound_mesh(file, unit, limits_for(any_size)).health;
  if (as_json) {
    json report = to_json(health);
    report["kind"] = health.is_cloud ? "cloud" : "mesh";
    report["file"] = file.string();
    print_json(std::cout, report);
    return;
  }
  std::cout << formatted("%s: %s, %zu vertices, %zu triangles, diameter %.1f mm", file.c_str(),
                         health.is_cloud ? "cloud" : "mesh", health.vertices, health.triangles,
                         1e3 * health.diameter);
  if (!health.is_cloud) {
    std::cout << (health.closed()
                      ? ", closed"
                      : formatted(", open (%.1f %% of the edges)", 100 * health.open_edge_share()));
  }
  std::cout << '\n';
  print_notes(std::cout, file, health);
  if (health.mended.empty() && health.warnings.empty()) std::cout << "nothing to mend\n";
}

void InfoCommand::show_model() const {
  const Model model = load_model(file);
  const ExpectedTime time = measure_expected_time(model);
  const size_t bytes = model.block().size();
  const MeshLimits limits;
  std::vector<std::string> warnings;
  if (model.diameter() < limits.min_diameter || model.diameter() > limits.max_diameter) {
    warnings.push_back(
        formatted("a diameter of %g m is unusual: was the mesh read in the right unit?", model.diameter()));
  }
  if (as_json) {
    NamedResult named{model.name(), file.string(), model.diameter(), model.centre(), model.symmetries(), {}};
    const json described = edgepose::to_json(named, "camera");
    const json report = {
        {"kind", "model"},
        {"file", file.string()},
        {"name", model.name()},
        {"diameter_m", model.diameter()},
        {"centre_m", described["centre_m"]},
        {"points", model.point_count()},
        {"pairs", model.pair_count()},
        {"symmetries", described["symmetries"]},
        {"file_bytes", bytes},
        {"expected_seconds_640x480",
         {{"preprocessing", time.preprocessing}, {"matching", time.matching}, {"total", time.total()}}},
        {"warnings", warnings}};
    print_json(std::cout, report);
    return;
  }
  print_summary(std::cout, model);
  std::cout << formatted("file and memory: %.1f MB, mapped and shared by all programs that use it\n",
                         1e-6 * static_cast<double>(bytes));
  std::cout << formatted(
      "expected time, 640x480: %.0f ms (%.0f ms of it once per image); measured here on the object "
      "before a wall, clutter adds to it\n",
      1e3 * time.total(), 1e3 * time.preprocessing);
  for (const std::string& line : warnings) std::cout << file.string() << ": warning: " << line << '\n';
}

}  // namespace

void add_info_command(CLI::App& app) {
  auto command = std::make_shared<InfoCommand>();
  CLI::App* info =
      app.add_subcommand("info", "Describe a trained model, or check a mesh before it is trained");
  info->add_option("FILE", command->file, "Model, mesh or cloud")->required();
  add_unit_option(*info, "--unit", command->unit, "a mesh");
  add_any_size_option(*info, command->any_size);
  info->add_flag("--json", command->as_json, "Print JSON");
  info->footer(kInfoExamples);
  info->callback([command] { command->run(); });
}

}  // namespace edgepose
