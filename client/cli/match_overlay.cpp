#include "client/cli/match_overlay.h"

#include <algorithm>
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

}  // namespace

void write_match_overlay(const std::filesystem::path& path, const SceneInput& scene,
                         const std::vector<ModelInput>& models, const std::vector<NamedResult>& results,
                         const std::vector<OverlayTarget>& targets) {
  std::vector<OverlayPose> with_mesh;
  for (size_t i = 0; i < models.size(); ++i) {
    if (!has_triangles(models[i])) continue;
    for (const Detection& detection : results[i].result.detections) {
      if (!shown(results[i], detection)) continue;
      const char* doubt = detection.accepted ? "" : "?";
      with_mesh.push_back({&*models[i].mesh, detection.camera_T_model,
                           results[i].name + doubt + formatted(" %.2f", detection.score),
                           kColours[i % kColours.size()], i == 0 ? targets : std::vector<OverlayTarget>{}});
    }
  }
  OverlayOptions options;
  options.zoom =
      std::all_of(models.begin(), models.end(), has_triangles);  // draw_samples() wants the whole image
  RgbImage picture = draw_overlay(scene.image, scene.camera, with_mesh, options);
  for (size_t i = 0; i < models.size(); ++i) {
    if (has_triangles(models[i])) continue;
    for (const Detection& detection : results[i].result.detections) {
      if (shown(results[i], detection)) {
        draw_samples(picture, scene, models[i].model, detection.camera_T_model,
                     kColours[i % kColours.size()]);
      }
    }
  }
  write_png(path, picture);
}

}  // namespace edgepose
