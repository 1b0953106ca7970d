#pragma once
#include <filesystem>
#include <iosfwd>
#include <optional>
#include <string>

#include "files/mesh_file.h"
#include "files/mesh_health.h"
#include "matcher/model.h"

namespace edgepose {

/// Upper end of every --threads option.
inline constexpr int kMaxThreads = 256;

/// A model ready to match, and its mesh if that is known.
struct ModelInput {
  std::filesystem::path file;
  Model model;
  std::optional<Mesh> mesh;
};

/// Trains on what was read from `file`, with a progress bar. Throws InputError that names the file.
Model train_from(const std::filesystem::path& file, const Mesh& mesh, const std::string& name,
                 const TrainOptions& options, const Symmetries& declared = {});

/// Loads a trained model, or trains one on the fly if `file` is a mesh (in `unit`), with a notice on stderr.
ModelInput load_or_train(const std::filesystem::path& file, LengthUnit unit, const MeshLimits& limits,
                         const TrainOptions& options);

/// Diameter, points, pairs and symmetries, a line each.
void print_summary(std::ostream& out, const Model& model);

}  // namespace edgepose
