#include "matcher/free_space.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace edgepose {
namespace {

/// What both judgements build on. Logarithms of shares: a sensor that blurs outlines denies many of them, one
/// that does not denies hardly any, so the step from none to some must count more than from some to many.
struct Features {
  float matched, unmeasured, coverage, disagreeing, near, violated, denied, confirmed, distance;

  Features(const FreeSpaceEvidence& e, const FreeSpaceOptions& options) {
    const float outline = std::max(1.f, e.outline_confirmed + e.outline_denied + e.outline_open);
    const auto share = [&](float against) { return against / (e.matched + against); };
    matched = std::log(e.matched / options.typical_points + 0.02f);
    unmeasured = e.unmeasured / e.expected;
    coverage = std::log(e.coverage() + 0.02f);
    disagreeing = std::log1p(share(e.disagreeing) / 0.03f);
    near = std::log1p(share(e.near) / 0.03f);
    violated = std::log1p(share(e.violated) / 0.01f);
    denied = std::log1p(e.outline_denied / outline / 0.05f);
    confirmed = e.outline_confirmed / outline;
    distance = std::log(e.distance_sum / e.matched / (0.01f * options.diameter) + 0.05f);
  }
};

/// How much the matched surface faces different ways: what a plane shows fits in many places.
float normal_spread(const FreeSpaceEvidence& e) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(e.normal_spread / e.matched,
                                                              Eigen::EigenvaluesOnly);
  return std::log(std::max(0.f, solver.eigenvalues()[0]) + 0.01f);
}

constexpr float kTooFew = 5;  // matched points

constexpr float kNear = 2.5f;  // [tolerances] farther off than surface that matches, too near for an occluder
constexpr float kInsideStep = 2;           // [pixels] from the outline to where the object must be
constexpr float kOutlineTolerance = 2.5f;  // in units of the surface tolerance

/// True if a neighbouring pixel shows the point: an outline one pixel off is no violation.
bool shown_beside(const Scene::Data& scene, int64_t pixel, float z, float tolerance) {
  const int u = static_cast<int>(pixel % scene.width), v = static_cast<int>(pixel / scene.width);
  for (const auto& [du, dv] : {std::pair{2, 0}, {-2, 0}, {0, 2}, {0, -2}}) {
    if (!scene.inside(u + du, v + dv)) continue;
    const float beside = scene.depth[scene.index(u + du, v + dv)];
    if (beside > 0 && beside < z + tolerance) return true;
  }
  return false;
}

/// The i-th point of a posed surface.
void examine_point(const Scene::Data& scene, const Model::View& model, const PoseF& pose,
                   const PosedSurface& surface, size_t i, const FreeSpaceOptions& options,
                   FreeSpaceEvidence& evidence) {
  const Eigen::Vector3f p(surface.x[i], surface.y[i], surface.z[i]),
      normal(surface.nx[i], surface.ny[i], surface.nz[i]);
  const float slant = -normal.dot(p) / p.z();  // of the normal against the ray with z = 1
  if (slant < 0.1f) return;                    // turned away in the true perspective
  const int32_t pixel = surface.pixel[i];
  if (pixel < 0) return;
  ++evidence.expected;
  const float z = scene.depth[static_cast<size_t>(pixel)];
  if (z <= 0) {
    ++evidence.unmeasured;
    return;
  }
  const float behind = z - p.z();
  const float distance = std::abs(behind) * slant;  // along the normal
  if (distance <= options.tolerance) {
    const Eigen::Vector3f& support_normal = model.support_normals[surface.indices[i]];
    const float cosine = scene.smooth_depth[static_cast<size_t>(pixel)] > 0
                             ? (pose.rotation * support_normal).dot(scene.normals[static_cast<size_t>(pixel)])
                             : options.min_normal_cosine;
    if (cosine >= options.min_normal_cosine) {
      evidence.matched += 1;
      evidence.distance_sum += distance;
      evidence.cosine_sum += cosine;
      evidence.normal_spread += normal * normal.transpose();
    } else {
      evidence.disagreeing += 1;
    }
  } else if (distance <= kNear * options.tolerance) {
    evidence.near += 1;
  } else if (behind < 0) {
    ++evidence.occluded;
    if (-behind < options.shallow_depth) ++evidence.shallow;
  } else if (shown_beside(scene, pixel, p.z(), 2 * options.tolerance)) {
    ++evidence.unmeasured;
  } else {
    ++evidence.violated;
  }
}

void examine_outline_point(const Scene::Data& scene, const PixelProjection& projection, const PoseF& pose,
                           const ContourPoint& point, const FreeSpaceOptions& options,
                           FreeSpaceEvidence& evidence) {
  const Eigen::Vector3f p = pose * point.position;
  if (!(p.z() > 1e-3f)) return;
  const Eigen::Vector3f beside = p + pose.rotation * point.outwards * scene.pixel_size(p.z());
  const Eigen::Vector2f at = projection.project(p), outwards = projection.project(beside) - at;
  const float tolerance = kOutlineTolerance * options.tolerance;
  const Eigen::Vector2f in = at - kInsideStep * outwards;
  const int64_t inside = projection.pixel_at(in.x(), in.y());
  if (inside < 0) return;
  const float z_in = scene.depth[inside];
  if (z_in <= 0 || z_in < p.z() - tolerance) {
    ++evidence.outline_open;
    return;
  }
  if (z_in > p.z() + tolerance) {
    ++evidence.outline_denied;
    return;
  }
  // Sensors blur outlines by some pixels: the farther out the surface ends, the less that confirms.
  for (const auto& [step, weight] : {std::pair{3.f, 1.f}, {6.f, 0.7f}, {9.f, 0.4f}}) {
    const Eigen::Vector2f out = at + step * outwards;
    const int64_t outside = projection.pixel_at(out.x(), out.y());
    if (outside < 0) return;
    const float z_out = scene.depth[outside];
    if (z_out <= 0 || z_out > z_in + tolerance) {
      const float sure = z_out <= 0 ? 0.5f : 1.f;
      evidence.outline_confirmed += sure * weight;
      evidence.outline_denied += sure * (1 - weight);
      evidence.outline_open += 1 - sure;
      return;
    }
    const bool creased = scene.smooth_depth[inside] > 0 && scene.smooth_depth[outside] > 0 &&
                         scene.normals[inside].dot(scene.normals[outside]) < 0.87f;
    if (z_out < z_in - tolerance || creased) {
      ++evidence.outline_open;
      return;
    }
  }
  ++evidence.outline_denied;
}

}  // namespace

FreeSpaceEvidence examine_pose(const Scene::Data& scene, const Model::View& model,
                               const PoseF& camera_T_model, const FreeSpaceOptions& options,
                               PosedSurface& surface) {
  FreeSpaceEvidence evidence;
  const PixelProjection projection(scene);
  const size_t view = view_of_pose(model, camera_T_model, box_centre(*model.header));
  surface.take(model, view, options.max_points);
  surface.place(camera_T_model, projection);
  for (size_t i = 0; i < surface.count(); ++i)
    examine_point(scene, model, camera_T_model, surface, i, options, evidence);
  if (!options.outline) return evidence;
  for (const ContourPoint& c : model.contour_from(view))
    examine_outline_point(scene, projection, camera_T_model, c, options, evidence);
  return evidence;
}

float rank_score(const FreeSpaceEvidence& e, const FreeSpaceOptions& options) {
  if (e.matched < kTooFew) return kNoEvidence;
  const Features f(e, options);
  return 8.f * f.matched + 2.4f * f.coverage - 0.6f * f.disagreeing - 1.2f * f.violated - 3.f * f.near -
         2.1f * f.distance - 2.6f * f.denied + 5.f * f.confirmed - 4.f * f.unmeasured;
}

float surface_score(const FreeSpaceEvidence& e, const FreeSpaceOptions& options) {
  if (e.matched < kTooFew) return kNoEvidence;
  const Features f(e, options);
  return 8.9f * f.matched - 0.65f * f.disagreeing - 0.5f * f.violated - 4.9f * f.near;
}

float acceptance_score(const FreeSpaceEvidence& e, const FreeSpaceOptions& options, int sightings) {
  if (e.matched < kTooFew) return 0;
  const Features f(e, options);
  const float logit = 2.65f + 1.38f * f.matched + 0.09f * f.coverage + 1.33f * f.disagreeing -
                      0.59f * f.violated - 1.48f * f.near - 0.53f * f.distance - 0.96f * f.denied +
                      1.94f * f.confirmed - 0.94f * f.unmeasured + 1.32f * normal_spread(e) +
                      1.74f * std::log(static_cast<float>(sightings));
  return 1 / (1 + std::exp(-logit));
}

}  // namespace edgepose
