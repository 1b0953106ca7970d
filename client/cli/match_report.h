#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

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

/// Prints it, indented, with a line end. What is no UTF-8, in the name of a file say, becomes U+FFFD.
void print_json(std::ostream& out, const nlohmann::json& report);

/// Everything that is known, SI units; docs/match_json.md lists the fields.
nlohmann::json to_json(const NamedResult& found, const std::string& frame);

/// A 4x4 row-major nested array.
nlohmann::json to_json(const RigidTransform& pose);

/// For people: one row a detection, millimetres and degrees; then the reason where nothing was found.
void print_table(std::ostream& out, const std::vector<NamedResult>& results, const std::string& frame,
                 double preprocessing_seconds);

}  // namespace edgepose
