#pragma once
#include <filesystem>
#include <vector>

#include "matcher/types.h"
#include "models/phantom/drill_plan.h"
#include "models/phantom/sample_scenes.h"

/// The files that the samples consist of. All throw InputError if a file cannot be written.
namespace edgepose::phantom {

inline constexpr const char* kName = "vertebra_phantom";

/// Largest distance between two vertices, in the mesh's unit.
double diameter(const Mesh& mesh);

/// drill_plan.json. `diameter_mm` is the model's.
void write_drill_plan(const std::filesystem::path& path, const std::vector<DrillTarget>& targets,
                      double diameter_mm);

/// A folder with depth.png (millimetres), camera.json (as BOP's) and truth.json (as BOP's scene_gt.json, and
/// the mesh's path, so that `edgepose render --scene` reads it).
void write_scene(const std::filesystem::path& folder, const SampleScene& scene);

/// A BOP set with one object, whose mesh must lie in models/obj_000001.ply, and a test image for each scene.
void write_sample_set(const std::filesystem::path& folder, const Mesh& mesh,
                      const std::vector<SampleScene>& scenes);

}  // namespace edgepose::phantom
