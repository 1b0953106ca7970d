#include "client/cli/train_command.h"

#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>

#include "client/cli/mesh_input.h"
#include "client/cli/model_input.h"
#include "client/cli/option_checks.h"
#include "client/cli/text.h"
#include "common/error.h"
#include "common/output_target.h"
#include "files/bop_json.h"
#include "files/model_file.h"
#include "files/whole_file.h"
#include "settings/matcher_settings.h"

namespace edgepose {
namespace {

constexpr const char* kTrainExamples = R"(Examples:
  edgepose train bolt.stl -o bolt.model
  edgepose train scan.ply --unit m -o scan.model --name scan
  edgepose train models/obj_000003.ply -o can.model --symmetries models/models_info.json --object-id 3)";

constexpr size_t kMaxModelsInfoBytes = 64u << 20;

struct TrainCommand {
  std::filesystem::path mesh, output, symmetries, config;
  LengthUnit unit = LengthUnit::kMillimetre;
  bool any_size = false;
  std::string name;
  int object_id = 0;
  int threads = 0;

  void run(bool threads_given) const;
};

Symmetries read_symmetries(const std::filesystem::path& models_info, int object_id) {
  std::string known;
  for (const TestObject& object :
       parse_bop_objects(read_whole_file(models_info, "a BOP models_info.json", kMaxModelsInfoBytes),
                         models_info.string())) {
    if (object.id == object_id) return object.symmetries;
    known += (known.empty() ? "" : ", ") + std::to_string(object.id);
  }
  throw InputError::at(models_info.string(), "an object " + std::to_string(object_id), "only " + known,
                       "give one of these as --object-id");
}

void TrainCommand::run(bool threads_given) const {
  TrainOptions options = config.empty() ? TrainOptions{} : read_settings(config).train;
  if (threads_given) options.threads = threads;
  check_output(output, {mesh, symmetries, config});
  const SoundMesh sound = read_sound_mesh(mesh, unit, limits_for(any_size));
  const Symmetries declared = symmetries.empty() ? Symmetries{} : read_symmetries(symmetries, object_id);

  const auto start = std::chrono::steady_clock::now();
  const std::string label = name.empty() ? mesh.stem().string() : name;
  const Model model = train_from(mesh, sound.mesh, label, options, declared);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  save_model(output, model);

  print_notes(std::cout, mesh, sound.health);
  print_summary(std::cout, model);
  std::cout << formatted("trained in %.2f s; %s: %.1f MB\n", seconds, output.c_str(),
                         1e-6 * static_cast<double>(model.block().size()));
}

}  // namespace

void add_train_command(CLI::App& app) {
  auto command = std::make_shared<TrainCommand>();
  CLI::App* train =
      app.add_subcommand("train", "Train a model from a mesh (PLY, STL, OBJ) or cloud (PLY, PCD)");
  train->add_option("MESH", command->mesh, "Mesh or cloud of the object")->required();
  add_output_option(*train, "-o,--output", command->output, "Model file to write")->required();
  add_unit_option(*train, "--unit", command->unit, "the mesh");
  add_any_size_option(*train, command->any_size);
  train->add_option("--name", command->name, "Name of the object (default: the mesh's file name)");
  CLI::Option* file =
      train->add_option("--symmetries", command->symmetries,
                        "BOP models_info.json that declares symmetries (else they are found)");
  CLI::Option* id = train->add_option("--object-id", command->object_id, "The object's number in that file");
  file->needs(id);
  id->needs(file);
  train->add_option("--config", command->config, "TOML file with any option (config/edgepose.toml)");
  CLI::Option* threads =
      train->add_option("--threads", command->threads, "Threads; 0 = all cores; never changes the result")
          ->check(CLI::Range(0, kMaxThreads));
  train->footer(kTrainExamples);
  train->callback([command, threads] { command->run(threads->count() > 0); });
}

}  // namespace edgepose
