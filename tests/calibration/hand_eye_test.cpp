#include "calibration/hand_eye.h"

#include <gtest/gtest.h>

#include <random>

#include "arm/rigid_motion.h"
#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

struct Bench {
  std::mt19937_64 random{3};
  std::normal_distribution<double> normal;
  RigidTransform flange_T_camera =
      rigid_transform(rotation_matrix(Eigen::Vector3d(0.02, -0.3, 1.5)), {0.08, -0.02, 0.06});
  RigidTransform base_T_target =
      rigid_transform(rotation_matrix(Eigen::Vector3d(2.5, 0.3, 0)), {0.5, 0.1, 0});

  Eigen::Vector3d gauss(double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return sigma * Eigen::Vector3d(x, y, z);
  }
  RigidTransform noise(double angle, double distance) {
    const Eigen::Vector3d turn = gauss(angle);
    return rigid_transform(rotation_matrix(turn), gauss(distance));
  }
  /// The flange turned by `turns` [rad, sigma a component] and moved by 5 cm about a place over the target.
  std::vector<HandEyeSample> samples(int count, const Eigen::Vector3d& turns, double pixel_noise = 0) {
    std::vector<HandEyeSample> result;
    const RigidTransform over = rigid_transform(rotation_matrix(Eigen::Vector3d(3, 0, 0)), {0.5, 0, 0.4});
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d turn = gauss(1).cwiseProduct(turns);
      const RigidTransform flange = over * rigid_transform(rotation_matrix(turn), gauss(0.05));
      result.push_back({flange, (flange * flange_T_camera).inverse() * base_T_target *
                                    noise(pixel_noise * 5, pixel_noise)});
    }
    return result;
  }
};

TEST(HandEye, FindsTheCamera) {
  Bench bench;
  const HandEye found = solve_hand_eye(bench.samples(12, {0.3, 0.3, 0.3}));
  EXPECT_LT((found.flange_T_camera.matrix() - bench.flange_T_camera.matrix()).norm(), 1e-6);
  EXPECT_LT(found.rms.translation, 1e-6);
  EXPECT_LT(found.worst.rotation, 1e-6);
  EXPECT_EQ(found.residuals.size(), 12u);
}

TEST(HandEye, NoiseIsAveragedAndShownAsResiduals) {
  Bench bench;
  const HandEye found = solve_hand_eye(bench.samples(30, {0.3, 0.3, 0.3}, 0.0003));
  const RigidTransform error = found.flange_T_camera.inverse() * bench.flange_T_camera;
  EXPECT_LT(error.translation().norm(), 0.001);
  EXPECT_LT(rotation_angle(error), 0.003);
  EXPECT_GT(found.rms.translation, 0.0002);
  EXPECT_LT(found.rms.translation, 0.002);
  EXPECT_GE(found.worst.translation, found.rms.translation);
}

TEST(HandEye, RefusesMotionsThatDoNotDetermineTheCamera) {
  Bench bench;
  expect_input_error(
      [&] {
        solve_hand_eye(bench.samples(12, {0, 0, 0.5}));
      },
      {"two different axes", "about the second", "wrist tilted"});
  expect_input_error([&] { solve_hand_eye(bench.samples(12, {0.01, 0.01, 0.01})); }, {"two different axes"});
  expect_input_error(
      [&] {
        solve_hand_eye(bench.samples(4, {0.3, 0.3, 0.3}));
      },
      {"at least 5 samples", "found 4"});
}

TEST(HandEye, RefusesSamplesThatContradictEachOther) {
  Bench bench;
  std::vector<HandEyeSample> samples = bench.samples(12, {0.3, 0.3, 0.3});
  for (size_t i = 0; i + 1 < samples.size(); i += 2)
    std::swap(samples[i].camera_T_target, samples[i + 1].camera_T_target);
  expect_input_error([&] { solve_hand_eye(samples); }, {"root mean square", "did the target stay in place"});
  samples = bench.samples(12, {0.3, 0.3, 0.3});
  samples[3].base_T_flange.linear() *= 1.5;
  expect_input_error([&] { solve_hand_eye(samples); }, {"sample 4", "rigid poses"});
}

}  // namespace
}  // namespace edgepose
