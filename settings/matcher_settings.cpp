#include "settings/matcher_settings.h"

#include "common/error.h"

namespace edgepose {

std::vector<SettingKey> setting_keys(Settings& settings) {
  TrainOptions& train = settings.train;
  SceneOptions& scene = settings.scene;
  MatchOptions& match = settings.match;
  PaperOptions& paper = match.paper;
  return {
      {"train.sampling_step", &train.sampling_step},
      {"train.distance_step", &train.distance_step},
      {"train.angle_step_deg", &train.angle_step_deg},
      {"train.min_normal_angle_deg", &train.min_normal_angle_deg},
      {"train.max_normal_angle_deg", &train.max_normal_angle_deg},
      {"train.visibility_filter", &train.visibility_filter},
      {"train.views", &train.views},
      {"train.find_symmetries", &train.find_symmetries},
      {"train.seed", &train.seed},
      {"train.max_table_mb", &train.max_table_mb},
      {"train.threads", &train.threads},
      {"scene.min_depth", &scene.min_depth},
      {"scene.max_depth", &scene.max_depth},
      {"scene.threads", &scene.threads},
      {"match.verification", &match.verification},
      {"match.max_instances", &match.max_instances},
      {"match.accept_score", &match.accept_score},
      {"match.edge_score", &match.edge_score},
      {"match.seed", &match.seed},
      {"match.threads", &match.threads},
      {"match.max_seconds", &match.max_seconds},
      {"match.sampling.keep_edges", &match.sampling.keep_edges},
      {"match.sampling.fine_theta_deg", &match.sampling.fine_theta_deg},
      {"match.sampling.theta_factor", &match.sampling.theta_factor},
      {"match.sampling.enough_points", &match.sampling.enough_points},
      {"match.sampling.max_pixel_size", &match.sampling.max_pixel_size},
      {"match.sampling.max_noise", &match.sampling.max_noise},
      {"match.voting.reference_share", &match.voting.reference_share},
      {"match.voting.min_references", &match.voting.min_references},
      {"match.voting.max_references", &match.voting.max_references},
      {"match.voting.peaks_per_reference", &match.voting.peaks_per_reference},
      {"match.voting.border", &match.voting.border},
      {"match.clustering.max_distance", &match.clustering.max_distance},
      {"match.clustering.max_angle_deg", &match.clustering.max_angle_deg},
      {"match.search.batch", &match.search.batch},
      {"match.search.coarse_candidates", &match.search.coarse_candidates},
      {"match.search.fine_candidates", &match.search.fine_candidates},
      {"match.search.sure_once", &match.search.sure_once},
      {"match.search.sure_twice", &match.search.sure_twice},
      {"match.search.sure_thrice", &match.search.sure_thrice},
      {"match.search.settled", &match.search.settled},
      {"match.tolerance.surface", &match.tolerance.surface},
      {"match.tolerance.noise_factor", &match.tolerance.noise_factor},
      {"match.tolerance.max_surface", &match.tolerance.max_surface},
      {"match.tolerance.min_normal_cosine", &match.tolerance.min_normal_cosine},
      {"match.tolerance.shallow_depth", &match.tolerance.shallow_depth},
      {"match.refinement.enabled", &match.refinement.enabled},
      {"match.refinement.first_iterations", &match.refinement.first_iterations},
      {"match.refinement.coarse_iterations", &match.refinement.coarse_iterations},
      {"match.refinement.fine_iterations", &match.refinement.fine_iterations},
      {"match.refinement.last_iterations", &match.refinement.last_iterations},
      {"match.refinement.outline_sigma", &match.refinement.outline_sigma},
      {"match.paper.candidates", &paper.candidates},
      {"match.paper.roi_scale", &paper.roi_scale},
      {"match.paper.accept_at_once", &paper.accept_at_once},
      {"match.paper.accept_best", &paper.accept_best},
      {"match.paper.edge_distance", &paper.edge_distance},
      {"match.paper.two_classes", &paper.two_classes},
      {"match.paper.early_exit", &paper.early_exit},
  };
}

void check_settings(const Settings& settings, const std::filesystem::path& file) {
  for (const std::string& fault : {settings.train.check(), settings.scene.check(), settings.match.check()}) {
    if (!fault.empty()) throw InputError(file.string() + ": " + fault);
  }
}

Settings read_settings(const std::filesystem::path& path) {
  return parse_settings(read_settings_text(path), path);  // every key is optional
}

Settings parse_settings(std::string_view text, const std::filesystem::path& file) {
  Settings settings;
  apply_toml(text, file, setting_keys(settings));
  check_settings(settings, file);
  return settings;
}

}  // namespace edgepose
