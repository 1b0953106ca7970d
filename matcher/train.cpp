#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

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

/// The surface that some outside view shows.
std::vector<OrientedPoint> visible_surface(const std::vector<OrientedPoint>& surface,
                                           const std::vector<Eigen::Vector3f>& directions, float diameter,
                                           const TrainOptions& options) {
  if (!options.visibility_filter) return surface;
  const auto views = look_from_all_sides(surface, surface, directions, diameter, 0, options.threads);
  std::vector<OrientedPoint> kept;
  for (size_t i = 0; i < surface.size(); ++i) {
    size_t seen = 0;
    for (const auto& view : views) seen += view.visible[i];
    if (seen >= 2) kept.push_back(surface[i]);
  }
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

PairFilter pair_filter(const std::vector<ViewVisibility>& views, size_t points,
                       const FeatureQuantiser& quantiser, const TrainOptions& options) {
  PairFilter filter;
  const float step_deg = 180.f / static_cast<float>(quantiser.angle_bins);
  // Whole buckets only, so that the scene can skip the same ones.
  filter.normal_bin_first = static_cast<uint32_t>(options.min_normal_angle_deg / step_deg + 0.01f);
  filter.normal_bin_last =
      static_cast<uint32_t>(std::ceil(options.max_normal_angle_deg / step_deg - 0.01f)) - 1;
  filter.seen_from.assign(points, std::vector<uint64_t>((views.size() + 63) / 64, 0));
  for (size_t v = 0; v < views.size(); ++v)
    for (size_t i = 0; i < points; ++i)
      if (views[v].visible[i]) filter.seen_from[i][v / 64] |= uint64_t{1} << (v % 64);
  return filter;
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
  parts.name = name;
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
  store_views(look_from_all_sides(surface, parts.dense_points, directions, diameter, kContourPointsPerView,
                                  options.threads),
              parts);
  report(0.7);

  FeatureQuantiser quantiser{1 / (options.distance_step * diameter), 0,
                             static_cast<uint32_t>(std::ceil(1 / options.distance_step - 1e-4f)) + 1,
                             static_cast<uint32_t>(std::lround(180 / options.angle_step_deg))};
  quantiser.inverse_angle_step = static_cast<float>(quantiser.angle_bins) / std::numbers::pi_v<float>;
  const auto coarse_views =
      look_from_all_sides(surface, parts.points, directions, diameter, 0, options.threads);
  const PairFilter filter = pair_filter(coarse_views, parts.points.size(), quantiser, options);
  PairTable table = build_pair_table(parts.points, quantiser, filter, options.threads);
  parts.offsets = std::move(table.offsets);
  parts.entries = std::move(table.entries);
  report(0.9);

  ModelHeader& h = parts.header;
  h.distance_bins = quantiser.distance_bins;
  h.angle_bins = quantiser.angle_bins;
  h.normal_bin_first = filter.normal_bin_first;
  h.normal_bin_last = filter.normal_bin_last;
  h.diameter = diameter;
  h.sampling_step = options.sampling_step * diameter;
  h.dense_step = kDenseStep * diameter;
  h.distance_step = options.distance_step * diameter;
  store_box(surface, h);
  store_symmetries(options.find_symmetries ? find_symmetries(parts.dense_points, diameter) : Symmetries{},
                   declared, parts);
  report(1);
  return make_model(parts);
}

}  // namespace edgepose
