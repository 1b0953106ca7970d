#include "matcher/detection.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "matcher/paper_verification.h"
#include "matcher/pose_comparison.h"

namespace edgepose {
namespace {

constexpr int kCell = 6;              // pixels
constexpr float kSameThing = 0.5f;    // share of common cells above which two poses explain the same thing
constexpr double kCorrelation = 2;    // neighbouring pixels err together: this many count as one measurement
constexpr double kLeastSigma = 1e-4;  // [d] no mesh is truer to its object than this

RigidTransform to_rigid(const PoseF& pose) {
  RigidTransform t = RigidTransform::Identity();
  t.linear() = Eigen::Quaterniond(pose.rotation.cast<double>()).normalized().toRotationMatrix();
  t.translation() = pose.translation.cast<double>();
  return t;
}

/// Inverse of the information, scaled to the residuals that are really there; directions that nothing holds
/// get the variance of a guess (a tenth of the diameter, 0.3 rad) instead of infinity.
Eigen::Matrix<double, 6, 6> covariance(const IcpResult& icp, double diameter) {
  const double sigma = std::max(static_cast<double>(icp.rms), kLeastSigma * diameter);
  const double assumed = icp.surface_sigma;
  Eigen::Matrix<double, 6, 6> information =
      icp.information * (assumed * assumed) / (sigma * sigma * kCorrelation);
  information.diagonal().head<3>().array() += 1 / (0.3 * 0.3);
  information.diagonal().tail<3>().array() += 1 / (0.01 * diameter * diameter);
  return information.inverse();
}

double edge_score_of(const Scene::Data& scene, const Model& model, const PoseF& pose,
                     const PaperOptions& options) {
  const float d = static_cast<float>(model.diameter());
  const auto near_model = model.view().near_model->get(model.view(), options.edge_distance * d);
  const SceneEdges edges(scene, 0.01f * d, d / 32, region_of_interest(model.view(), pose, options.roi_scale));
  return edge_score(edges, model.view(), *near_model, pose, options);
}

/// The best score among the candidates that differ clearly from all that is reported; 0 if there is none.
float best_rival(const std::vector<Candidate>& candidates, const std::vector<PoseF>& reported,
                 const PoseComparison& comparison) {
  float best = 0;
  for (const Candidate& c : candidates) {
    const bool known = std::any_of(reported.begin(), reported.end(),
                                   [&](const PoseF& pose) { return comparison.same_answer(pose, c.pose); });
    if (!known) best = std::max(best, c.confidence);
  }
  return best;
}

/// Why the best guess is not accepted, in words.
std::string rejection_reason(const Candidate& best, const MatchOptions& options) {
  const auto percent = [](float share) { return std::to_string(std::lround(100 * share)) + " %"; };
  const auto two_digits = [](double score) {  // rounded, as tables are
    const long hundredths = std::lround(100 * score);
    return std::to_string(hundredths / 100) + (hundredths % 100 < 10 ? ".0" : ".") +
           std::to_string(hundredths % 100);
  };
  const FreeSpaceEvidence& e = best.evidence;
  std::string reason = "the best candidate has score " + two_digits(best.confidence) + " of the " +
                       two_digits(options.accept_score) + " wanted: " + percent(e.coverage()) +
                       " of the expected surface is there";
  if (e.violation_share() > 0.03f) reason += ", the scene sees through " + percent(e.violation_share());
  if (e.expected > 0 && e.occluded / e.expected > 0.3f)
    reason += ", " + percent(e.occluded / e.expected) + " would be hidden";
  if (e.expected > 0 && e.near / e.expected > 0.15f)
    reason += ", " + percent(e.near / e.expected) + " lies beside the surface";
  const float outline = e.outline_confirmed + e.outline_denied + e.outline_open;
  if (outline > 0 && e.outline_denied / outline > 0.1f)
    reason += ", " + percent(e.outline_denied / outline) + " of its outline is contradicted";
  return reason;
}

}  // namespace

std::vector<uint32_t> explained_cells(const Scene::Data& scene, const Model::View& model,
                                      const PoseF& camera_T_model, const FreeSpaceOptions& options) {
  const PixelProjection projection(scene);
  const size_t view = view_of_pose(model, camera_T_model, box_centre(*model.header));
  const uint32_t cells_a_row = static_cast<uint32_t>(scene.width / kCell + 1);
  std::vector<uint32_t> cells;
  for_visible_points(model, view, options.max_points, [&](size_t i) {
    const Eigen::Vector3f p = camera_T_model * model.dense_points[i].position;
    const int64_t pixel = projection.pixel(p);
    if (pixel < 0 || std::abs(scene.depth[pixel] - p.z()) > 2 * options.tolerance) return;
    const auto u = static_cast<uint32_t>(pixel % scene.width), v = static_cast<uint32_t>(pixel / scene.width);
    cells.push_back(v / kCell * cells_a_row + u / kCell);
  });
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  return cells;
}

float overlap(const std::vector<uint32_t>& cells, const std::vector<uint32_t>& others) {
  if (cells.empty()) return 0;
  std::vector<uint32_t> common;
  std::set_intersection(cells.begin(), cells.end(), others.begin(), others.end(), std::back_inserter(common));
  return static_cast<float>(common.size()) / static_cast<float>(cells.size());
}

Report report_detections(const Scene::Data& scene, const Model& model, const std::vector<Candidate>& ranked,
                         const CandidateSearch& search, const MatchOptions& options) {
  const Model::View& view = model.view();
  const PoseComparison comparison(model);
  Report report;
  std::vector<Detection>& detections = report.detections;
  std::vector<PoseF> reported;
  std::vector<uint32_t> explained;
  for (const Candidate& found : ranked) {
    if (detections.size() >= static_cast<size_t>(options.max_instances)) break;
    const Candidate c = search.polish(found);
    const bool accepted =
        options.verification != Verification::kFreeSpace || c.confidence >= options.accept_score;
    if (!detections.empty() && (!accepted || options.verification != Verification::kFreeSpace)) continue;
    if (!accepted) report.reason = rejection_reason(c, options);
    const auto cells = explained_cells(scene, view, c.pose, search.settings(c.pose).full);
    if (overlap(cells, explained) > kSameThing) continue;
    explained.insert(explained.end(), cells.begin(), cells.end());
    std::sort(explained.begin(), explained.end());

    Detection detection;
    detection.camera_T_model = to_rigid(c.pose);
    detection.score = c.confidence;
    detection.accepted = accepted;
    if (options.edge_score || options.verification == Verification::kPaper)
      detection.edge_score = edge_score_of(scene, model, c.pose, options.paper);
    detection.coverage = c.evidence.coverage();
    detection.violations = c.evidence.violation_share();
    detection.votes = c.votes;
    detection.sightings = c.sightings;
    detection.covariance = covariance(c.icp, model.diameter());
    for (const RigidTransform& symmetry : model.symmetries().discrete)
      detection.equivalent.push_back(detection.camera_T_model * symmetry);
    detections.push_back(detection);
    reported.push_back(c.pose);
  }
  const float rival = best_rival(ranked, reported, comparison);
  for (Detection& detection : detections) detection.margin = detection.score - static_cast<double>(rival);
  // The candidates' order and their scores are different judgements: the first need not be an accepted one.
  std::stable_partition(detections.begin(), detections.end(),
                        [](const Detection& each) { return each.accepted; });
  if (detections.empty()) {
    report.reason = "no candidate pose: too few scene points where the object could be";
  } else if (detections.front().accepted) {
    report.reason.clear();
  }
  return report;
}

}  // namespace edgepose
