#pragma once
#include <filesystem>
#include <vector>

#include "client/cli/match_report.h"
#include "client/cli/model_input.h"
#include "client/cli/scene_input.h"
#include "render/overlay.h"

namespace edgepose {

/// Draws the accepted poses (camera frame), or where there is none the best guess, over the depth image and
/// writes a PNG. Models whose mesh is not known are drawn from the surface samples in their model file.
/// `targets` belong to every pose of the first model.
void write_match_overlay(const std::filesystem::path& path, const SceneInput& scene,
                         const std::vector<ModelInput>& models, const std::vector<NamedResult>& results,
                         const std::vector<OverlayTarget>& targets);

/// The surface samples of a model as small discs.
Mesh sample_discs(const Model& model);

/// The outline of such discs where they are seen, over a picture of the whole scene, enlarged by a whole
/// factor.
void draw_samples(RgbImage& picture, const SceneInput& scene, const OverlayPose& pose);

}  // namespace edgepose
