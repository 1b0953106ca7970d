#include "client/cli/match_overlay.h"

#include <array>

#include "client/cli/text.h"

namespace edgepose {
namespace {

constexpr std::array<Colour, 6> kColours = {
    {{64, 240, 120}, {255, 150, 40}, {90, 200, 255}, {255, 100, 200}, {200, 255, 60}, {190, 140, 255}}};

bool has_triangles(const ModelInput& model) { return model.mesh && !model.mesh->triangles.empty(); }

bool shown(const NamedResult& named, const Detection& detection) {
  return detection.accepted || (!named.found() && &detection == &named.result.detections.front());
}

/// Those of one model that are drawn; `mesh` must outlive them.
std::vector<OverlayPose> poses_of(const NamedResult& named, const Mesh& mesh, const Colour& colour,
                                  const std::vector<OverlayTarget>& targets) {
  std::vector<OverlayPose> poses;
  for (const Detection& detection : named.result.detections) {
    if (!shown(named, detection)) continue;
    const char* doubt = detection.accepted ? "" : "?";
    poses.push_back({&mesh, detection.camera_T_model,
                     named.name + doubt + formatted(" %.2f", detection.score), colour, targets});
  }
  return poses;
}

}  // namespace

void write_match_overlay(const std::filesystem::path& path, const SceneInput& scene,
                         const std::vector<ModelInput>& models, const std::vector<NamedResult>& results,
                         const std::vector<OverlayTarget>& targets) {
  std::vector<OverlayPose> with_mesh, with_samples;
  std::vector<Mesh> samples(models.size());
  for (size_t i = 0; i < models.size(); ++i) {
    const bool triangles = has_triangles(models[i]);
    if (!triangles) samples[i] = sample_discs(models[i].model);
    auto& list = triangles ? with_mesh : with_samples;
    for (OverlayPose& pose :
         poses_of(results[i], triangles ? *models[i].mesh : samples[i], kColours[i % kColours.size()],
                  i == 0 ? targets : std::vector<OverlayTarget>{}))
      list.push_back(std::move(pose));
  }
  OverlayOptions options;
  options.zoom = with_samples.empty();  // draw_samples() wants the whole image
  RgbImage picture = draw_overlay(scene.image, scene.camera, with_mesh, options);
  for (const OverlayPose& pose : with_samples) draw_samples(picture, scene, pose);
  if (!with_samples.empty()) annotate_overlay(picture, scene.image, scene.camera, with_samples, options);
  write_png(path, picture);
}

}  // namespace edgepose
