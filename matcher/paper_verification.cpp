#include "matcher/paper_verification.h"

#include <algorithm>
#include <numeric>
#include <unordered_set>

#include "matcher/linkage.h"
#include "matcher/parallel.h"
#include "matcher/point_grid.h"

namespace edgepose {
namespace {

constexpr float kClusterLink = 0.05f;  // [d] edge points closer than this belong to one cluster
constexpr float kClusterReach =
    0.6f;  // [d] clusters whose centre is farther from the pose's centre are clutter

/// The pixels that a box may cover; all of the image if it reaches behind the camera.
Eigen::AlignedBox2i pixels_of(const Scene::Data& scene, const Eigen::AlignedBox3f& box) {
  const Eigen::AlignedBox2i image(Eigen::Vector2i::Zero(),
                                  Eigen::Vector2i(scene.width - 1, scene.height - 1));
  if (!(box.min().z() > 1e-3f)) return image;
  const PixelProjection projection(scene);
  Eigen::AlignedBox2f seen;
  for (int corner = 0; corner < 8; ++corner)
    seen.extend(projection.project(box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner))));
  // Clamped before they become whole numbers: a box beside the image may be any number of pixels off.
  const Eigen::Vector2f size(static_cast<float>(scene.width), static_cast<float>(scene.height));
  const Eigen::Vector2f low = (seen.min().array() - 1).max(-1.f).min(size.array()),
                        high = (seen.max().array() + 2).max(-1.f).min(size.array());
  return Eigen::AlignedBox2i(low.cast<int>(), high.cast<int>()).intersection(image);
}

/// The edge points inside the pose's axis-aligned box times `scale`, without far clusters (Fig. 5, red and
/// blue).
std::vector<Eigen::Vector3f> edges_in_roi(const SceneEdges& edges, const Model::View& model,
                                          const PoseF& pose, float scale) {
  const Eigen::AlignedBox3f region = region_of_interest(model, pose, scale);
  const Eigen::Vector3f centre = region.center();
  std::vector<Eigen::Vector3f> inside;
  for (const Eigen::Vector3f& p : edges.points())
    if (region.contains(p)) inside.push_back(p);

  const float d = static_cast<float>(model.header->diameter);
  const auto cluster = link_clusters(inside, kClusterLink * d);
  std::vector<std::pair<Eigen::Vector3f, float>> sums;
  for (size_t i = 0; i < inside.size(); ++i) {
    if (cluster[i] >= sums.size()) sums.resize(cluster[i] + 1, {Eigen::Vector3f::Zero(), 0.f});
    sums[cluster[i]].first += inside[i];
    sums[cluster[i]].second += 1;
  }
  std::vector<Eigen::Vector3f> kept;
  for (size_t i = 0; i < inside.size(); ++i) {
    const auto& [sum, count] = sums[cluster[i]];
    if ((sum / count - centre).norm() <= kClusterReach * d) kept.push_back(inside[i]);
  }
  return kept;
}

}  // namespace

SceneEdges::SceneEdges(const Scene::Data& scene, float cell, float max_pixel_size)
    : SceneEdges(scene, cell, max_pixel_size,
                 {Eigen::Vector3f::Constant(-1e9f), Eigen::Vector3f::Constant(1e9f)}) {}

SceneEdges::SceneEdges(const Scene::Data& scene, float cell, float max_pixel_size,
                       const Eigen::AlignedBox3f& within) {
  const Eigen::AlignedBox2i pixels = pixels_of(scene, within);
  std::unordered_set<uint64_t> taken;
  for (int v = pixels.min().y(); v <= pixels.max().y(); ++v)
    for (int u = pixels.min().x(); u <= pixels.max().x(); ++u) {
      const size_t at = scene.index(u, v);
      if (scene.edges[at] == EdgeKind::kNone || scene.pixel_size(scene.depth[at]) > max_pixel_size) continue;
      const Eigen::Vector3f p = scene.point(u, v);
      if (within.contains(p) && taken.insert(cell_key(p, 1 / cell)).second) points_.push_back(p);
    }
}

Eigen::AlignedBox3f region_of_interest(const Model::View& model, const PoseF& camera_T_model, float scale) {
  const ModelHeader& h = *model.header;
  Eigen::AlignedBox3f box;
  for (int corner = 0; corner < 8; ++corner) {
    const auto pick = [&](int axis) {
      return static_cast<float>((corner >> axis & 1 ? h.box_max : h.box_min)[static_cast<size_t>(axis)]);
    };
    box.extend(camera_T_model * Eigen::Vector3f(pick(0), pick(1), pick(2)));
  }
  const Eigen::Vector3f centre = box.center(), half = box.sizes() / 2 * scale;
  return {centre - half, centre + half};
}

float matching_edges(const SceneEdges& edges, const Model::View& model, const NearModel& near_model,
                     const PoseF& camera_T_model) {
  const Eigen::Vector3f centre = camera_T_model * box_centre(*model.header);
  const float reach = 0.6f * static_cast<float>(model.header->diameter);
  float count = 0;
  for (const Eigen::Vector3f& p : edges.points()) {
    if ((p - centre).squaredNorm() > reach * reach) continue;
    count += near_model(camera_T_model.rotation.transpose() * (p - camera_T_model.translation));
  }
  return count;
}

float edge_score(const SceneEdges& edges, const Model::View& model, const NearModel& near_model,
                 const PoseF& camera_T_model, const PaperOptions& options) {
  const auto roi = edges_in_roi(edges, model, camera_T_model, options.roi_scale);
  if (roi.empty()) return 0;
  float matching = 0;
  for (const Eigen::Vector3f& p : roi)
    matching += near_model(camera_T_model.rotation.transpose() * (p - camera_T_model.translation));
  return matching / static_cast<float>(roi.size());
}

float surface_overlap(const Scene::Data& scene, const Model::View& model, const PoseF& camera_T_model,
                      float distance) {
  const PixelProjection projection(scene);
  float near = 0;
  for (const OrientedPoint& m : model.points) {
    const Eigen::Vector3f p = camera_T_model * m.position;
    const int64_t pixel = projection.pixel(p);
    if (pixel >= 0 && scene.depth[pixel] > 0) near += std::abs(scene.depth[pixel] - p.z()) < distance;
  }
  return near / static_cast<float>(model.points.size());
}

size_t verify_like_the_paper(const SceneEdges& edges, const Model::View& model,
                             const std::vector<PoseF>& poses, const std::vector<float>& votes,
                             const PaperOptions& options, int threads, size_t* detailed) {
  const auto cached =
      model.near_model->get(model, options.edge_distance * static_cast<float>(model.header->diameter));
  const NearModel& near_model = *cached;
  size_t looked_at = 0, best = 0;
  float best_score = -1;
  // One class after the other; in each, the N poses that most edges support get the score of Eq. 2.
  const auto verify_class = [&](size_t first, size_t last) {
    std::vector<float> support(last - first);
    parallel_for(last - first, threads,
                 [&](size_t i) { support[i] = matching_edges(edges, model, near_model, poses[first + i]); });
    std::vector<size_t> order(last - first);
    std::iota(order.begin(), order.end(), first);
    std::stable_sort(order.begin(), order.end(),
                     [&](size_t a, size_t b) { return support[a - first] > support[b - first]; });
    const size_t wanted = static_cast<size_t>(options.candidates) * (options.two_classes ? 1 : 2);
    order.resize(std::min(order.size(), wanted));
    for (size_t i : order) {
      const float score = edge_score(edges, model, near_model, poses[i], options);
      ++looked_at;
      if (score > best_score) best_score = score, best = i;
      if (options.early_exit && score > options.accept_at_once) return true;
    }
    return options.early_exit && best_score > options.accept_best;
  };
  size_t second_class = poses.size();
  if (options.two_classes && !votes.empty())
    second_class = static_cast<size_t>(
        std::find_if(votes.begin(), votes.end(), [&](float v) { return v < votes[0] / 2; }) - votes.begin());
  if (!verify_class(0, second_class) && second_class < poses.size()) verify_class(second_class, poses.size());
  if (detailed) *detailed = looked_at;
  return best;
}

}  // namespace edgepose
