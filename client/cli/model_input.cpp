#include "client/cli/model_input.h"

#include <iostream>

#include "client/cli/mesh_input.h"
#include "client/cli/progress_bar.h"
#include "client/cli/text.h"
#include "files/model_file.h"

namespace edgepose {

ModelInput load_or_train(const std::filesystem::path& file, LengthUnit unit, const TrainOptions& options) {
  if (!is_mesh_file(file)) return {file, load_model(file), std::nullopt};
  SoundMesh sound = read_sound_mesh(file, unit);
  print_notes(std::cerr, file, sound.health);
  const std::string name = file.stem().string();
  std::cerr << file.string() << ": a mesh, trained on the fly; edgepose train saves that time\n";
  Model model = train_model(sound.mesh, name, options, {}, progress_bar("training " + name));
  return {file, std::move(model), std::move(sound.mesh)};
}

void print_summary(std::ostream& out, const Model& model) {
  const Symmetries symmetries = model.symmetries();
  out << formatted("%s: diameter %.1f mm, %zu points, %zu pairs\n", model.name().c_str(),
                   1e3 * model.diameter(), model.point_count(), model.pair_count());
  if (symmetries.empty()) {
    out << "symmetries: none\n";
    return;
  }
  out << formatted("symmetries: %zu turns onto itself", symmetries.discrete.size());
  for (const SymmetryAxis& axis : symmetries.continuous) {
    out << formatted("; round about (%.3f %.3f %.3f) through (%.1f %.1f %.1f) mm", axis.direction.x(),
                     axis.direction.y(), axis.direction.z(), 1e3 * axis.point.x(), 1e3 * axis.point.y(),
                     1e3 * axis.point.z());
  }
  out << '\n';
}

}  // namespace edgepose
