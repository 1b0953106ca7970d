#pragma once
#include <vector>

#include "matcher/match.h"

namespace edgepose {

/// Where an instance was shortly before.
struct TrackStart {
  RigidTransform camera_T_model = RigidTransform::Identity();
  int sightings = 1;  ///< as Detection::sightings: following adds no evidence of its own
};

/// Follows instances of `model` from where they were: refines each pose and verifies it anew, without voting.
/// As long as they move by less than about 0.06 diameters between images. The result is as match()'s; what is
/// lost is not accepted. Paper mode: as match() refines and scores, without a verdict.
MatchResult track(const Scene& scene, const Model& model, const std::vector<TrackStart>& starts,
                  const MatchOptions& options = {});

/// A rectangle of pixels: columns [left, left + width), rows [top, top + height).
struct ImageWindow {
  int left = 0, top = 0, width = 0, height = 0;
  bool empty() const { return width <= 0 || height <= 0; }
};

/// What the model may cover in an image of `width` x `height`, and `margin` [d] around it, so that what lies
/// beside it can be judged too; at least 64 pixels a side where the image has them. Empty if the model is not
/// in front of the camera or not in the image.
ImageWindow window_around(const Model& model, const RigidTransform& camera_T_model, const Camera& camera,
                          int width, int height, float margin);
ImageWindow united(const ImageWindow& a, const ImageWindow& b);

/// The part of the image within the window, which must lie in it; and the camera that sees just that.
DepthImage cut_out(const DepthImage& image, const ImageWindow& window);
Camera cut_out(const Camera& camera, const ImageWindow& window);

}  // namespace edgepose
