#include "reporting/match_json.h"

#include <nlohmann/json.hpp>

namespace edgepose {
namespace {

using nlohmann::json;

template <class Vector>
json to_array(const Vector& vector) {
  json array = json::array();
  for (Eigen::Index i = 0; i < vector.size(); ++i) array.push_back(static_cast<double>(vector[i]));
  return array;
}

json to_nested(const Eigen::MatrixXd& matrix) {
  json rows = json::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) rows.push_back(to_array(Eigen::VectorXd(matrix.row(i))));
  return rows;
}

/// (w, x, y, z) with w >= 0, so that equal rotations print equally.
json quaternion_wxyz(const RigidTransform& pose) {
  Eigen::Quaterniond q(pose.linear());
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

json to_json(const Detection& detection, const std::string& frame) {
  json equivalent = json::array();
  for (const RigidTransform& pose : detection.equivalent) equivalent.push_back(edgepose::to_json(pose));
  return {{frame + "_T_model", edgepose::to_json(detection.camera_T_model)},
          {"quaternion_wxyz", quaternion_wxyz(detection.camera_T_model)},
          {"translation_m", to_array(Eigen::Vector3d(detection.camera_T_model.translation()))},
          {"score", detection.score},
          {"accepted", detection.accepted},
          {"edge_score", detection.edge_score ? json(*detection.edge_score) : json()},
          {"coverage", detection.coverage},
          {"violations", detection.violations},
          {"margin", detection.margin},
          {"votes", detection.votes},
          {"covariance", to_nested(detection.covariance)},
          {"equivalent", equivalent}};
}

json to_json(const Symmetries& symmetries) {
  json discrete = json::array(), continuous = json::array();
  for (const RigidTransform& pose : symmetries.discrete) discrete.push_back(edgepose::to_json(pose));
  for (const SymmetryAxis& axis : symmetries.continuous) {
    continuous.push_back({{"point_m", to_array(axis.point)}, {"direction", to_array(axis.direction)}});
  }
  return {{"discrete_model_T_model", discrete},
          {"continuous", continuous},
          {"any_rotation", symmetries.is_sphere()}};
}

}  // namespace

MatchResult in_frame(const RigidTransform& target_T_camera, MatchResult result) {
  Eigen::Matrix<double, 6, 6> turn = Eigen::Matrix<double, 6, 6>::Zero();
  turn.topLeftCorner<3, 3>() = target_T_camera.linear();
  turn.bottomRightCorner<3, 3>() = target_T_camera.linear();
  for (Detection& detection : result.detections) {
    detection.camera_T_model = target_T_camera * detection.camera_T_model;
    for (RigidTransform& pose : detection.equivalent) pose = target_T_camera * pose;
    detection.covariance = turn * detection.covariance * turn.transpose();
  }
  return result;
}

json to_json(const RigidTransform& pose) { return to_nested(pose.matrix()); }

json to_json(const NamedResult& found, const std::string& frame) {
  const MatchResult& result = found.result;
  json detections = json::array();
  for (const Detection& detection : result.detections) detections.push_back(to_json(detection, frame));
  return {{"model", found.name},
          {"file", found.file},
          {"diameter_m", found.diameter},
          {"centre_m", to_array(found.centre)},
          {"symmetries", to_json(found.symmetries)},
          {"found", found.found()},
          {"reason", result.reason},
          {"cut_short", result.cut_short},
          {"detections", detections},
          {"scene_points", result.scene_points},
          {"reference_points", result.reference_points},
          {"candidates", result.candidates},
          {"seconds",
           {{"sampling", result.times.sampling},
            {"voting", result.times.voting},
            {"clustering", result.times.clustering},
            {"verification", result.times.verification},
            {"refinement", result.times.refinement},
            {"total", result.times.total()}}}};
}

}  // namespace edgepose
