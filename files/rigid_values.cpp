#include "files/rigid_values.h"

#include <Eigen/SVD>
#include <cmath>

#include "common/error.h"
#include "files/number_text.h"

namespace edgepose {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
// Poses fitted by other programs miss a rotation by 0.01 and more; a wrong unit or order misses it by far.
constexpr double kTolerance = 0.05;

Eigen::Matrix3d nearest_rotation(const Eigen::Matrix3d& matrix) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

}  // namespace

RigidTransform rigid_from_row_major(const std::vector<double>& rotation,
                                    const std::vector<double>& translation_mm, const std::string& where) {
  if (rotation.size() != 9 || translation_mm.size() != 3)
    throw InputError::at(where, "9 rotation values and 3 of translation",
                         std::to_string(rotation.size()) + " and " + std::to_string(translation_mm.size()));
  const Eigen::Matrix3d matrix = Eigen::Map<const RowMajor3>(rotation.data());
  const Eigen::Vector3d translation = Eigen::Map<const Eigen::Vector3d>(translation_mm.data()) * 1e-3;
  // Not maxCoeff(): it may skip a NaN.
  const double skew = (matrix.transpose() * matrix - Eigen::Matrix3d::Identity()).norm();
  if (!(skew < kTolerance))
    throw InputError::at(where, "a rotation matrix (rows of length 1, perpendicular)",
                         "one that misses it by " + number_text(skew, 3));
  if (matrix.determinant() < 0) throw InputError::at(where, "a rotation matrix", "one that mirrors");
  if (!(translation.norm() <= kMaxTranslation))
    throw InputError::at(where, "a translation within " + number_text(kMaxTranslation) + " m",
                         number_text(translation.norm(), 6) + " m", "translations are in millimetres");
  RigidTransform result = RigidTransform::Identity();
  result.linear() = nearest_rotation(matrix);
  result.translation() = translation;
  return result;
}

RigidTransform rigid_from_matrix(const std::vector<double>& matrix, const std::string& where) {
  if (matrix.size() != 16)
    throw InputError::at(where, "the 16 values of a 4 x 4 matrix", std::to_string(matrix.size()) + " values");
  const double miss = (Eigen::Map<const Eigen::Vector4d>(&matrix[12]) - Eigen::Vector4d::UnitW()).norm();
  if (!(miss < 1e-6))
    throw InputError::at(where, "0 0 0 1 as the last row",
                         numbers_text({matrix.begin() + 12, matrix.end()}, 6),
                         "the matrix must be written row by row");
  std::vector<double> rotation;
  for (const size_t row : {0, 4, 8}) rotation.insert(rotation.end(), &matrix[row], &matrix[row] + 3);
  return rigid_from_row_major(rotation, {matrix[3], matrix[7], matrix[11]}, where);
}

}  // namespace edgepose
