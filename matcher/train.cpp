#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <tuple>

#include "matcher/model.h"
#include "matcher/model_block.h"
#include "matcher/pair_table.h"
#include "matcher/surface_sampling.h"
#include "matcher/symmetry.h"
#include "matcher/view_sphere.h"

namespace edgepose {
namespace {

constexpr size_t kSurfaceSamples = 80000;     // about 0.006 d apart on a compact object
constexpr float kNormalRadius = 0.03f;        // [d] support of the table's normals, as wide as the scene's
constexpr float kDenseNormalRadius = 0.012f;  // [d] of the finer ones
constexpr float kSupportRadius = 0.035f;      // [d] of those compared with the scene's
constexpr float kDenseStep = 0.018f;          // [d]
constexpr size_t kMaxDensePoints = 8000;
constexpr size_t kContourPointsPerView = 120;
constexpr uint8_t kEnoughViews = 2;  // that show a point: one alone may look through a hole between samples
constexpr size_t kViewsAtOnce = 16;

/// The surface that some outside view shows.
std::vector<OrientedPoint> visible_surface(const std::vector<OrientedPoint>& surface,
                                           const std::vector<Eigen::Vector3f>& directions, float diameter,
                                           const TrainOptions& options) {
  if (!options.visibility_filter) return surface;
  // A few views from all around show most points twice: the others need to be asked only for the rest.
  const size_t rounds = (directions.size() + kViewsAtOnce - 1) / kViewsAtOnce;
  std::vector<uint8_t> seen(surface.size(), 0);
  for (size_t round = 0; round < rounds; ++round) {
    std::vector<Eigen::Vector3f> some;
    for (size_t i = round; i < directions.size(); i += rounds) some.push_back(directions[i]);
    std::vector<uint32_t> open;
    std::vector<OrientedPoint> queries;
    for (uint32_t i = 0; i < surface.size(); ++i)
      if (seen[i] < kEnoughViews) open.push_back(i), queries.push_back(surface[i]);
    if (open.empty()) break;
    for (const auto& view : look_from_all_sides(surface, queries, some, diameter, 0, options.threads))
      for (size_t k = 0; k < open.size(); ++k)
        seen[open[k]] += view.visible[k] && seen[open[k]] < kEnoughViews;
  }
  std::vector<OrientedPoint> kept;
  for (size_t i = 0; i < surface.size(); ++i)
    if (seen[i] >= kEnoughViews) kept.push_back(surface[i]);
  return kept;
}

void store_views(const std::vector<ViewVisibility>& views, ModelParts& parts) {
  const size_t words = (parts.dense_points.size() + 63) / 64;
  parts.visible.assign(words * views.size(), 0);
  parts.contour_offsets.push_back(0);
  for (size_t v = 0; v < views.size(); ++v) {
    for (size_t i = 0; i < parts.dense_points.size(); ++i)
      if (views[v].visible[i]) parts.visible[v * words + i / 64] |= uint64_t{1} << (i % 64);
    parts.contours.insert(parts.contours.end(), views[v].contour.begin(), views[v].contour.end());
    parts.contour_offsets.push_back(static_cast<uint32_t>(parts.contours.size()));
  }
}

/// `first`: where the table's points begin among those that the views tell of.
PairFilter pair_filter(const std::vector<ViewVisibility>& views, size_t first, size_t points,
                       const TrainOptions& options) {
  constexpr float kDegrees = 180, kRadians = std::numbers::pi_v<float>;
  PairFilter filter;
  filter.min_normal_angle = options.min_normal_angle_deg / kDegrees * kRadians;
  filter.max_normal_angle = options.max_normal_angle_deg / kDegrees * kRadians;
  filter.seen_from.assign(points, std::vector<uint64_t>((views.size() + 63) / 64, 0));
  for (size_t v = 0; v < views.size(); ++v)
    for (size_t i = 0; i < points; ++i)
      if (views[v].visible[first + i]) filter.seen_from[i][v / 64] |= uint64_t{1} << (v % 64);
  return filter;
}

FeatureQuantiser make_quantiser(const TrainOptions& options, float diameter) {
  const auto angle_bins = static_cast<uint32_t>(std::lround(180 / options.angle_step_deg));
  return {1 / (options.distance_step * diameter), static_cast<float>(angle_bins) / std::numbers::pi_v<float>,
          static_cast<uint32_t>(std::ceil(1 / options.distance_step - 1e-4f)) + 1, angle_bins};
}

void require_affordable(const TableSize& table, int limit_mb) {
  constexpr double kMega = 1e6;
  if (table.total() <= limit_mb * kMega) return;
  const bool buckets = table.bucket_bytes > table.pair_bytes;
  throw std::invalid_argument(std::string(buckets ? "angle_step_deg, distance_step" : "sampling_step") +
                              ": expected a table of at most max_table_mb = " + std::to_string(limit_mb) +
                              " MB, found about " + std::to_string(std::lround(table.total() / kMega)) +
                              " MB, most of it " +
                              (buckets ? "buckets; take larger steps" : "point pairs; take a larger step"));
}

void store_box(const std::vector<OrientedPoint>& points, ModelHeader& header) {
  for (int axis = 0; axis < 3; ++axis) {
    header.box_min[axis] = std::numeric_limits<double>::max(), header.box_max[axis] = -header.box_min[axis];
    for (const auto& p : points) {
      header.box_min[axis] = std::min(header.box_min[axis], static_cast<double>(p.position[axis]));
      header.box_max[axis] = std::max(header.box_max[axis], static_cast<double>(p.position[axis]));
    }
  }
}

}  // namespace

std::string TrainOptions::check() const {
  if (!(sampling_step >= 0.01f && sampling_step <= 0.2f))
    return "sampling_step: expected 0.01 to 0.2 diameters";
  if (!(distance_step >= 0.005f && distance_step <= 0.2f))
    return "distance_step: expected 0.005 to 0.2 diameters";
  if (!(angle_step_deg >= 2 && angle_step_deg <= 45)) return "angle_step_deg: expected 2 to 45 degrees";
  if (!(min_normal_angle_deg >= 0 && min_normal_angle_deg < max_normal_angle_deg &&
        max_normal_angle_deg <= 180))
    return "min_normal_angle_deg, max_normal_angle_deg: expected 0 <= min < max <= 180 degrees";
  if (views < 20 || views > 2000) return "views: expected 20 to 2000";
  if (max_table_mb < 1 || max_table_mb > 4096) return "max_table_mb: expected 1 to 4096 MB";
  if (threads < 0) return "threads: expected 0 (all cores) or more";
  return "";
}

Model train_model(const Mesh& mesh, const std::string& name, const TrainOptions& options,
                  const Symmetries& declared, const Progress& progress) {
  if (const std::string fault = options.check(); !fault.empty()) throw std::invalid_argument(fault);
  const auto report = [&](double done) {
    if (progress) progress(done);
  };

  std::vector<OrientedPoint> surface = sample_surface(mesh, kSurfaceSamples, options.seed);
  const auto directions = view_directions(options.views);
  float diameter = largest_distance(surface);
  if (!(diameter > 0)) throw std::invalid_argument("expected a surface with an extent, found a single point");
  report(0.1);
  surface = visible_surface(surface, directions, diameter, options);
  diameter = largest_distance(surface);
  report(0.4);

  ModelParts parts;
  parts.name = name.substr(0, kMaxModelName);
  std::replace_if(parts.name.begin(), parts.name.end(), is_control, ' ');
  parts.view_directions = directions;
  const auto coarse =
      thin_out(surface, {4 * options.sampling_step * diameter, options.sampling_step * diameter});
  if (coarse.size() > 65535)
    throw std::invalid_argument("sampling_step: more than 65535 points; take a larger one");
  parts.points = smooth_normals(surface, coarse, kNormalRadius * diameter, options.threads);
  auto dense =
      thin_out(surface, {16 * kDenseStep * diameter, 8 * kDenseStep * diameter, 4 * kDenseStep * diameter,
                         2 * kDenseStep * diameter, kDenseStep * diameter});
  if (dense.size() > kMaxDensePoints) dense.resize(kMaxDensePoints);
  parts.dense_points = smooth_normals(surface, dense, kDenseNormalRadius * diameter, options.threads);
  for (const OrientedPoint& p : smooth_normals(surface, dense, kSupportRadius * diameter, options.threads))
    parts.support_normals.push_back(p.normal);
  std::vector<OrientedPoint> queries = parts.dense_points;
  queries.insert(queries.end(), parts.points.begin(), parts.points.end());
  const auto views =
      look_from_all_sides(surface, queries, directions, diameter, kContourPointsPerView, options.threads);
  store_views(views, parts);
  report(0.7);

  const FeatureQuantiser quantiser = make_quantiser(options, diameter);
  const PairFilter filter = pair_filter(views, parts.dense_points.size(), parts.points.size(), options);
  require_affordable(estimate_table(parts.points, quantiser, filter), options.max_table_mb);
  PairTable table = build_pair_table(parts.points, quantiser, filter, options.threads);
  parts.offsets = std::move(table.offsets);
  parts.entries = std::move(table.entries);
  report(0.9);

  ModelHeader& h = parts.header;
  h.distance_bins = quantiser.distance_bins;
  h.angle_bins = quantiser.angle_bins;
  std::tie(h.normal_bin_first, h.normal_bin_last) = normal_bins(filter, quantiser);
  h.diameter = diameter;
  h.sampling_step = options.sampling_step * diameter;
  h.dense_step = kDenseStep * diameter;
  h.distance_step = options.distance_step * diameter;
  store_box(surface, h);
  const bool search = options.find_symmetries && declared.empty();
  store_symmetries(search ? find_symmetries(parts.dense_points, surface, diameter) : declared, parts);
  report(1);
  return make_model(parts);
}

}  // namespace edgepose
