#pragma once
#include "matcher/posed_surface.h"

namespace edgepose {

/// What the scene says about a posed model, point by point and along its outline.
struct FreeSpaceEvidence {
  float expected = 0;     ///< surface points that this view should show, inside the image
  float matched = 0;      ///< the scene has the surface there, facing the same way
  float disagreeing = 0;  ///< there is surface at this depth, but it faces another way
  float near = 0;         ///< there is surface nearby, but not within the tolerance
  float violated = 0;     ///< the scene is behind: the object would have been seen
  float occluded = 0;     ///< the scene is in front
  float shallow =
      0;  ///< ... by less than a tenth of a diameter: an occluder that close is rarely another object
  float unmeasured = 0;         ///< no measurement
  float outline_confirmed = 0;  ///< outline points where the scene falls away behind the object
  float outline_denied = 0;     ///< ... where the surface goes on smoothly, or nothing is
  float outline_open = 0;       ///< ... where an occluder, a touching surface or a hole leaves it open
  float distance_sum = 0;       ///< [m] of the matched points' distances
  float cosine_sum = 0;         ///< of the matched points' normals against the scene's
  Eigen::Matrix3f normal_spread = Eigen::Matrix3f::Zero();  ///< sum of n n^T over the matched points

  float coverage() const { return expected > 0 ? matched / expected : 0; }
  float violation_share() const { return expected > 0 ? violated / expected : 0; }
};

struct FreeSpaceOptions {
  float tolerance = 0.002f;     ///< [m] distance within which surface is the same
  float shallow_depth = 0.01f;  ///< [m] occluders in front by less count as shallow
  float diameter = 0.1f;        ///< [m] of the model
  float typical_points = 500;   ///< points that a view on the unoccluded model shows, of `max_points`
  float min_normal_cosine = 0.6f;
  size_t max_points = 1000;  ///< dense points looked at; time is proportional
  bool outline = true;
};

/// Projects the model's visible points and outline into the image (default verification; docs/matcher.md).
/// `surface`: where the points are posed; for one model, to be kept for the next pose.
FreeSpaceEvidence examine_pose(const Scene::Data& scene, const Model::View& model,
                               const PoseF& camera_T_model, const FreeSpaceOptions& options,
                               PosedSurface& surface);

inline constexpr float kNoEvidence = -1000;

/// Orders the candidates for one model in one scene; higher is better, no absolute meaning. The weights come
/// from a conditional logistic regression (which candidate of an image is the right one) over rendered and
/// real scenes (docs/matcher.md).
float rank_score(const FreeSpaceEvidence& evidence, const FreeSpaceOptions& options);

/// Another order, for the choice of candidates that are worth refining: how much of the surface is there at
/// all.
float surface_score(const FreeSpaceEvidence& evidence, const FreeSpaceOptions& options);

/// [0, 1] the probability that the best candidate is right, by logistic regression. `sightings`: how many
/// rounds of 75 references (sightings.h) have led to it, each by itself; what is not there is seldom found
/// twice.
float acceptance_score(const FreeSpaceEvidence& evidence, const FreeSpaceOptions& options, int sightings);

}  // namespace edgepose
