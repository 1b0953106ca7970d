#include "matcher/clustering.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

using fixtures::Random;

Eigen::Matrix3f near(const Eigen::Matrix3d& rotation, double angle, Random& random) {
  return (rotation * Eigen::AngleAxisd(angle, random.direction()).toRotationMatrix()).cast<float>();
}

TEST(MeanRotation, DoesNotDependOnTheOrder) {
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    const Eigen::Matrix3d middle = random.rotation();
    std::vector<Eigen::Matrix3f> rotations;
    std::vector<float> weights;
    for (int i = 0; i < 8; ++i) {
      rotations.push_back(near(middle, random.uniform(0, 0.3), random));
      weights.push_back(static_cast<float>(random.uniform(0.5, 3)));
    }
    const Eigen::Matrix3f mean = mean_rotation(rotations, weights);
    EXPECT_NEAR(mean.determinant(), 1, 1e-5f);
    EXPECT_LT(angle_between(mean, middle.cast<float>()), 0.3f);
    std::reverse(rotations.begin(), rotations.end());
    std::reverse(weights.begin(), weights.end());
    EXPECT_LT((mean_rotation(rotations, weights) - mean).norm(), 1e-5f);
  }
}

TEST(MeanRotation, HasNoTroubleWithTheQuaternionsSign) {
  // On either side of a half turn the quaternions have opposite signs; their plain mean would be far off.
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    const Eigen::Vector3d axis = random.direction();
    const auto turn = [&](double a) {
      return Eigen::Matrix3f(Eigen::AngleAxisd(a, axis).toRotationMatrix().cast<float>());
    };
    const Eigen::Matrix3f mean =
        mean_rotation({turn(std::numbers::pi - 0.1), turn(std::numbers::pi + 0.1)}, {1, 1});
    EXPECT_LT((mean - turn(std::numbers::pi)).norm(), 1e-4f);
  }
}

TEST(MeanRotation, FollowsTheWeights) {
  const Eigen::Matrix3f zero = Eigen::Matrix3f::Identity();
  const Eigen::Matrix3f turned = Eigen::AngleAxisf(0.2f, Eigen::Vector3f::UnitZ()).toRotationMatrix();
  EXPECT_NEAR(angle_between(mean_rotation({zero, turned}, {1, 1}), zero), 0.1f, 2e-3f);
  EXPECT_NEAR(angle_between(mean_rotation({zero, turned}, {1, 3}), zero), 0.15f, 2e-3f);
}

TEST(ClusterPoses, AnyTwoPosesOfAClusterAreWithinTheLimits) {
  const Model& model = fixtures::bracket_model();
  const auto d = static_cast<float>(model.diameter());
  const Eigen::Vector3f centre = model.centre().cast<float>();
  const ClusteringOptions options;
  size_t total = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const Eigen::Matrix3d middle = random.rotation();
    // Votes that are powers of two: the sum of a cluster tells who is in it.
    std::vector<PoseHypothesis> poses;
    for (int i = 0; i < 20; ++i) {
      const Eigen::Matrix3f r = near(middle, random.uniform(0, 0.5), random);
      const Eigen::Vector3f t = (random.vector(0.1) * static_cast<double>(d)).cast<float>();
      poses.push_back({r, t - r * centre, static_cast<float>(1 << i)});
    }
    const auto clusters = cluster_poses(poses, model, options);
    uint32_t seen = 0;
    for (size_t c = 0; c < clusters.size(); ++c) {
      if (c > 0) {
        EXPECT_GE(clusters[c - 1].votes, clusters[c].votes);
      }
      const auto members = static_cast<uint32_t>(clusters[c].votes);
      EXPECT_EQ(seen & members, 0u);
      seen |= members;
      for (uint32_t i = 0; i < 20; ++i)
        for (uint32_t k = 0; k < i; ++k) {
          if (!(members >> i & 1) || !(members >> k & 1)) continue;
          const auto &a = poses[i], &b = poses[k];
          const Eigen::Vector3f apart =
              a.rotation * centre + a.translation - b.rotation * centre - b.translation;
          EXPECT_LE(apart.norm(), options.max_distance * d * 1.0001f);
          EXPECT_LE(angle_between(a.rotation, b.rotation), options.max_angle_deg * 0.017454f);
        }
    }
    EXPECT_EQ(seen, (1u << 20) - 1) << "a pose got lost";
    EXPECT_GT(clusters.size(), 1u);
    total += clusters.size();
  }
  EXPECT_LT(total, 40u * 20u) << "nothing was ever joined";
}

TEST(ClusterPoses, NothingInNothingOut) {
  EXPECT_TRUE(cluster_poses({}, fixtures::bracket_model(), {}).empty());
}

}  // namespace
}  // namespace edgepose
