#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "matcher/match.h"

namespace edgepose {

/// One model's answer, in the frame that the user asked in: "camera" (depth image) or "cloud".
struct NamedResult {
  std::string name, file;                            ///< of the model
  double diameter = 0;                               ///< [m]
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m] of the model, model frame
  Symmetries symmetries;
  MatchResult result;

  bool found() const { return !result.detections.empty() && result.detections.front().accepted; }
};

/// The same result seen from another frame: poses, equivalent poses and covariances.
MatchResult in_frame(const RigidTransform& target_T_camera, MatchResult result);

/// Everything that is known, SI units; docs/match_json.md lists the fields.
nlohmann::json to_json(const NamedResult& found, const std::string& frame);

/// A 4x4 row-major nested array.
nlohmann::json to_json(const RigidTransform& pose);

}  // namespace edgepose
