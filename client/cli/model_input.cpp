#include "client/cli/model_input.h"

#include <iostream>

#include "client/cli/mesh_input.h"
#include "client/cli/progress_bar.h"
#include "client/cli/text.h"
#include "common/naming.h"
#include "files/model_file.h"

namespace edgepose {

Model train_from(const std::filesystem::path& file, const Mesh& mesh, const std::string& name,
                 const TrainOptions& options, const Symmetries& declared) {
  return naming(file.string(),
                [&] { return train_model(mesh, name, options, declared, progress_bar("training " + name)); });
}

ModelInput load_or_train(const std::filesystem::path& file, LengthUnit unit, const MeshLimits& limits,
                         const TrainOptions& options) {
  if (!is_mesh_file(file)) return {file, load_model(file), std::nullopt};
  SoundMesh sound = read_sound_mesh(file, unit, limits);
  print_notes(std::cerr, file, sound.health);
  const std::string name = file.stem().string();
  std::cerr << file.string() << ": a mesh, trained on the fly; edgepose train saves that time\n";
  Model model = train_from(file, sound.mesh, name, options);
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
  if (symmetries.is_sphere()) {
    const Eigen::Vector3d centre = 1e3 * symmetries.continuous.front().point;
    out << formatted("symmetries: sphere, any rotation about (%.1f %.1f %.1f) mm\n", centre.x(), centre.y(),
                     centre.z());
    return;
  }
  out << formatted("symmetries: %zu turns onto itself", symmetries.discrete.size());
  for (const SymmetryAxis& axis : symmetries.continuous) {
    const Eigen::Vector3d along = axis.direction.unaryExpr([](double value) { return rounded(value, 3); });
    const Eigen::Vector3d point =
        (1e3 * axis.point).unaryExpr([](double value) { return rounded(value, 1); });
    out << formatted("; round about (%.3f %.3f %.3f) through (%.1f %.1f %.1f) mm", along.x(), along.y(),
                     along.z(), point.x(), point.y(), point.z());
  }
  out << '\n';
}

}  // namespace edgepose
