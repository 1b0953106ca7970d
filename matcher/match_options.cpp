#include "matcher/match_options.h"

#include <array>
#include <cmath>

#include "matcher/option_range.h"

namespace edgepose {
namespace {

constexpr double kTiny = 1e-6;  // lower end of what must be above zero

}  // namespace

std::string SamplingOptions::check() const {
  return option_fault({{"fine_theta_deg", fine_theta_deg, 1, 90},
                       {"theta_factor", theta_factor, 0.1, 1},
                       {"enough_points", static_cast<double>(enough_points), 0, 1e6},
                       {"max_pixel_size", max_pixel_size, 1e-3, 1},
                       {"max_noise", max_noise, 1e-4, 1}});
}

std::string VotingOptions::check() const {
  return option_fault(
      {{"reference_share", reference_share, kTiny, 1},
       {"min_references", static_cast<double>(min_references), 1, 1e5},
       {"max_references", static_cast<double>(max_references), static_cast<double>(min_references), 1e5},
       {"peaks_per_reference", static_cast<double>(peaks_per_reference), 1, 100},
       {"border", border, 0, 0.5}});
}

std::string ClusteringOptions::check() const {
  return option_fault({{"max_distance", max_distance, 1e-3, 1}, {"max_angle_deg", max_angle_deg, 1, 90}});
}

std::string SearchOptions::check() const {
  return option_fault(
      {{"batch", static_cast<double>(batch), 1, 1e5},
       {"coarse_candidates", static_cast<double>(coarse_candidates), 1, 1e4},
       {"fine_candidates", static_cast<double>(fine_candidates), 1, static_cast<double>(coarse_candidates)},
       {"sure_once", sure_once, 0, 2},
       {"sure_twice", sure_twice, 0, 2},
       {"sure_thrice", sure_thrice, 0, 2},
       {"settled", settled, 0, 1e5}});
}

std::string ToleranceOptions::check() const {
  return option_fault({{"surface", surface, 1e-4, 0.2},
                       {"noise_factor", noise_factor, 0, 10},
                       {"max_surface", max_surface, surface, 0.3},
                       {"min_normal_cosine", min_normal_cosine, 0, 0.999},
                       {"shallow_depth", shallow_depth, 0, 1}});
}

std::string RefinementOptions::check() const {
  return option_fault({{"first_iterations", static_cast<double>(first_iterations), 0, 100},
                       {"coarse_iterations", static_cast<double>(coarse_iterations), 1, 100},
                       {"fine_iterations", static_cast<double>(fine_iterations), 1, 100},
                       {"last_iterations", static_cast<double>(last_iterations), 1, 100},
                       {"outline_sigma", outline_sigma, 0.1, 100}});
}

std::string PaperOptions::check() const {
  return option_fault({{"candidates", static_cast<double>(candidates), 1, 1000},
                       {"roi_scale", roi_scale, 1, 4},
                       {"accept_at_once", accept_at_once, 0, 2},
                       {"accept_best", accept_best, 0, 2},
                       {"edge_distance", edge_distance, 1e-4, 0.2}});
}

std::string MatchOptions::check() const {
  const std::array<std::pair<const char*, std::string>, 7> stages = {{{"sampling", sampling.check()},
                                                                      {"voting", voting.check()},
                                                                      {"clustering", clustering.check()},
                                                                      {"search", search.check()},
                                                                      {"tolerance", tolerance.check()},
                                                                      {"refinement", refinement.check()},
                                                                      {"paper", paper.check()}}};
  for (const auto& [stage, fault] : stages)
    if (!fault.empty()) return stage + ("." + fault);
  return option_fault({{"max_instances", static_cast<double>(max_instances), 1, 100},
                       {"accept_score", accept_score, 0, 1},
                       {"threads", static_cast<double>(threads), 0, 256},
                       {"max_seconds", max_seconds, 0, 3600}});
}

}  // namespace edgepose
