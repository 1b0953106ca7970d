#include "calibration/transform_json.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "arm/rigid_motion.h"
#include "files/number_text.h"

namespace edgepose {
namespace {

constexpr double kRounding = 1e-3;

Eigen::Matrix3d matrix_from(const JsonNode& node) {
  const std::vector<JsonNode> rows = node.items();
  if (rows.size() != 3) node.fail("3 rows of 3 numbers");
  Eigen::Matrix3d matrix;
  for (int row = 0; row < 3; ++row) matrix.row(row) = rows[row].vector().transpose();
  const double miss = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm();
  if (!(miss <= kRounding))
    throw InputError::at(node.where(), "a rotation matrix (rows of length 1, perpendicular)",
                         "one that misses it by " + number_text(miss, 3));
  if (matrix.determinant() < 0) throw InputError::at(node.where(), "a rotation matrix", "one that mirrors");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Eigen::Matrix3d turned_by(const JsonNode& node) {
  const Eigen::Vector3d vector = node.vector();
  if (const double angle = vector.stableNorm(); !(angle <= 2 * std::numbers::pi))
    throw InputError::at(node.where(), "a rotation vector of at most 6.28 rad",
                         number_text(angle, 6) + " rad", "angles are in radians: are these degrees?");
  return rotation_matrix(vector);
}

}  // namespace

RigidTransform transform_from(const JsonNode& node, double reach) {
  const auto matrix = node.find("rotation");
  const Eigen::Matrix3d rotation = matrix ? matrix_from(*matrix) : turned_by(node.at("rotation_vector_rad"));
  const JsonNode place = node.at("translation_m");
  const Eigen::Vector3d translation = place.vector();
  if (const double length = translation.stableNorm(); !(length <= reach))
    throw InputError::at(place.where(), "at most " + number_text(reach, 3) + " m",
                         number_text(length, 6) + " m", "lengths are in metres");
  return rigid_transform(rotation, translation);
}

nlohmann::ordered_json transform_json(const RigidTransform& transform) {
  nlohmann::ordered_json json;
  for (int row = 0; row < 3; ++row) {
    const Eigen::RowVector3d values = transform.linear().row(row);
    json["rotation"].push_back({values[0], values[1], values[2]});
  }
  const Eigen::Vector3d place = transform.translation();
  json["translation_m"] = {place[0], place[1], place[2]};
  return json;
}

JointVector joints_from(const JsonNode& node) {
  const std::vector<double> values = node.numbers(kJoints);
  for (const double value : values)
    if (!(std::abs(value) <= 4 * std::numbers::pi))
      throw InputError::at(node.where(), "six angles of at most two turns, 12.57 rad",
                           number_text(value, 6) + " rad", "angles are in radians: are these degrees?");
  return Eigen::Map<const JointVector>(values.data());
}

void check_kind(const JsonNode& root, const std::string& kind) {
  const JsonNode node = root.at("kind");
  if (const std::string found = node.text(); found != kind)
    throw InputError::at(node.where(), "\"" + kind + "\"", "\"" + printable(found) + "\"",
                         "is it another file?");
}

std::string time_from(const JsonNode& node) {
  const std::string text = node.text();
  static const std::string kPattern = "0000-00-00T00:00:00Z";
  bool sound = text.size() == kPattern.size();
  for (size_t i = 0; sound && i < text.size(); ++i)
    sound = kPattern[i] == '0' ? text[i] >= '0' && text[i] <= '9' : text[i] == kPattern[i];
  if (!sound) node.fail("a time as 2026-11-23T09:30:00Z");
  return text;
}

std::string name_from(const JsonNode& node) {
  std::string name = node.text();
  if (trim(name).empty() || name.size() > 200) node.fail("a name of 1 to 200 characters");
  return name;
}

double residual_from(const JsonNode& node) {
  const double value = node.number();
  if (value < 0) node.fail("a number of at least 0");
  return value;
}

}  // namespace edgepose
