#include "calibration/hand_eye.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <optional>
#include <sstream>

#include "arm/rigid_motion.h"
#include "common/error.h"
#include "matcher/option_range.h"
#include "servoing/proper_pose.h"

namespace edgepose {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr double kMetrePerRadian =
    0.35;  // weighs rotation against translation: at the distance that one works at

struct Method {
  const char* name;
  cv::HandEyeCalibrationMethod number;
};
constexpr std::array<Method, 5> kMethods = {{{"tsai", cv::CALIB_HAND_EYE_TSAI},
                                             {"park", cv::CALIB_HAND_EYE_PARK},
                                             {"horaud", cv::CALIB_HAND_EYE_HORAUD},
                                             {"andreff", cv::CALIB_HAND_EYE_ANDREFF},
                                             {"daniilidis", cv::CALIB_HAND_EYE_DANIILIDIS}}};

cv::Mat rotation_of(const RigidTransform& pose) {
  cv::Mat matrix(3, 3, CV_64F);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) matrix.at<double>(row, column) = pose.linear()(row, column);
  return matrix;
}

cv::Mat translation_of(const RigidTransform& pose) {
  cv::Mat vector(3, 1, CV_64F);
  for (int row = 0; row < 3; ++row) vector.at<double>(row) = pose.translation()[row];
  return vector;
}

/// What one of OpenCV's methods says; nothing if it fails.
std::optional<RigidTransform> solved(const std::vector<HandEyeSample>& samples, const Method& method) {
  std::vector<cv::Mat> flange_rotations, flange_translations, target_rotations, target_translations;
  for (const HandEyeSample& sample : samples) {
    flange_rotations.push_back(rotation_of(sample.base_T_flange));
    flange_translations.push_back(translation_of(sample.base_T_flange));
    target_rotations.push_back(rotation_of(sample.camera_T_target));
    target_translations.push_back(translation_of(sample.camera_T_target));
  }
  cv::Mat rotation, translation;
  try {
    cv::calibrateHandEye(flange_rotations, flange_translations, target_rotations, target_translations,
                         rotation, translation, method.number);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  if (rotation.total() != 9 || translation.total() != 3) return std::nullopt;
  RigidTransform result = RigidTransform::Identity();
  for (int row = 0; row < 3; ++row) {
    result.translation()[row] = translation.at<double>(row);
    for (int column = 0; column < 3; ++column)
      result.linear()(row, column) = rotation.at<double>(row, column);
  }
  if (!is_proper(result)) return std::nullopt;
  return result;
}

HandEye judged(const RigidTransform& flange_T_camera, const char* method,
               const std::vector<HandEyeSample>& samples) {
  std::vector<RigidTransform> targets;
  for (const HandEyeSample& sample : samples)
    targets.push_back(sample.base_T_flange * flange_T_camera * sample.camera_T_target);
  const RigidTransform mean = mean_pose(targets);
  HandEye result{flange_T_camera, method, {}, {}, {}};
  for (const RigidTransform& target : targets) {
    const HandEyeResidual residual{(target.translation() - mean.translation()).norm(),
                                   rotation_angle(mean.inverse() * target)};
    result.residuals.push_back(residual);
    result.worst.translation = std::max(result.worst.translation, residual.translation);
    result.worst.rotation = std::max(result.worst.rotation, residual.rotation);
  }
  const PoseSpread all = spread(targets, mean);
  result.rms = {all.translation, all.rotation};
  return result;
}

double badness(const HandEye& result) {
  return std::hypot(result.rms.translation, kMetrePerRadian * result.rms.rotation);
}

/// [rad] root mean square of the flange's turns, from their mean, about the axis that is second best known.
double second_turn(const std::vector<HandEyeSample>& samples) {
  std::vector<RigidTransform> flanges;
  for (const HandEyeSample& sample : samples) flanges.push_back(sample.base_T_flange);
  const RigidTransform mean = mean_pose(flanges);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const RigidTransform& flange : flanges) {
    const Eigen::Vector3d turn = rotation_vector(mean.linear().transpose() * flange.linear());
    moments += turn * turn.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(moments / static_cast<double>(flanges.size()),
                                                              Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues()[1]));
}

std::string degrees(double radians) {
  std::ostringstream text;
  text.precision(3);
  text << radians * kDegrees << " degrees";
  return text.str();
}

void check_samples(const std::vector<HandEyeSample>& samples, const HandEyeOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("hand-eye." + fault);
  if (samples.size() < static_cast<size_t>(options.min_samples))
    throw InputError::at("hand-eye", "at least " + std::to_string(options.min_samples) + " samples",
                         std::to_string(samples.size()));
  for (size_t i = 0; i < samples.size(); ++i)
    if (!is_proper(samples[i].base_T_flange) || !is_proper(samples[i].camera_T_target))
      throw InputError::at("hand-eye sample " + std::to_string(i + 1), "rigid poses of flange and target",
                           "another");
  if (const double turn = second_turn(samples); !(turn >= options.min_turn))
    throw InputError::at("hand-eye",
                         "a flange that turns by " + degrees(options.min_turn) +
                             " (root mean square) about two different axes",
                         degrees(turn) + " about the second",
                         "take samples with the wrist tilted in all directions");
}

}  // namespace

std::string HandEyeOptions::check() const {
  return option_fault({{"min_samples", static_cast<double>(min_samples), 3, 10000},
                       {"min_turn", min_turn, 0.01, 1},
                       {"max_residual", max_residual, 1e-6, 1},
                       {"max_turn_residual", max_turn_residual, 1e-6, 1}});
}

HandEye solve_hand_eye(const std::vector<HandEyeSample>& samples, const HandEyeOptions& options) {
  check_samples(samples, options);
  std::optional<HandEye> best;
  for (const Method& method : kMethods) {
    const std::optional<RigidTransform> flange_T_camera = solved(samples, method);
    if (!flange_T_camera) continue;
    const HandEye result = judged(*flange_T_camera, method.name, samples);
    if (!best || badness(result) < badness(*best)) best = result;
  }
  if (!best)
    throw InputError("hand-eye: no method finds a rigid pose of the camera; are the samples in order?");
  if (!(best->rms.translation <= options.max_residual && best->rms.rotation <= options.max_turn_residual)) {
    std::ostringstream found;
    found.precision(3);
    found << best->rms.translation * 1e3 << " mm and " << degrees(best->rms.rotation);
    std::ostringstream expected;
    expected.precision(3);
    expected << "a target that stays within " << options.max_residual * 1e3 << " mm and "
             << degrees(options.max_turn_residual) << " (root mean square)";
    throw InputError::at("hand-eye", expected.str(), found.str(),
                         "did the target stay in place, and are both poses of a sample of one moment?");
  }
  return *best;
}

}  // namespace edgepose
