#include "matcher/voting.h"

#include <gtest/gtest.h>

#include <numeric>

#include "matcher/feature_batch.h"
#include "tests/matcher/search_fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket_model;

std::vector<OrientedPoint> random_points(size_t count, uint64_t seed) {
  fixtures::Random random(seed);
  std::vector<OrientedPoint> points;
  for (size_t i = 0; i < count; ++i)
    points.push_back({random.vector(0.5).cast<float>(), random.direction().cast<float>()});
  return points;
}

TEST(PartnerSearch, RunsHoldEveryPointWithinReachOnceAndNotTheWholeScene) {
  const auto points = random_points(2000, 1);
  constexpr float kReach = 0.15f;
  const PartnerSearch search(points, kReach);
  std::vector<PartnerSearch::Run> runs;
  for (size_t i = 0; i < 50; ++i) {
    size_t within = 0, expected = 0, held = 0;
    for (const OrientedPoint& p : points) expected += (p.position - points[i].position).norm() <= kReach;
    search.runs_near(points[i].position, runs);
    uint32_t last = 0;
    for (const auto& [begin, end] : runs) {
      ASSERT_LE(last, begin);
      ASSERT_LT(begin, end);
      last = end;
      held += end - begin;
      for (uint32_t k = begin; k < end; ++k) {
        const Eigen::Vector3f p(search.points().x[k], search.points().y[k], search.points().z[k]);
        within += (p - points[i].position).norm() <= kReach;
      }
    }
    EXPECT_EQ(within, expected);
    EXPECT_LT(held, points.size() / 2);
  }
}

TEST(FeatureBatch, SaysWhatThePairAloneSays) {
  const auto points = random_points(300, 2);
  const FeatureQuantiser quantiser = {1 / 0.01f, 15 / std::numbers::pi_v<float>, 20, 15};
  const PartnerSearch search(points, 0.3f);
  FeatureBatch batch;
  for (size_t i = 0; i < 20; ++i) {
    const ReferenceFrame frame(points[i]);
    batch.compute(points[i], frame, search.points(), {0, 300}, quantiser);
    const PointArrays& p = search.points();
    for (size_t k = 0; k < 300; ++k) {
      const OrientedPoint second = {{p.x[k], p.y[k], p.z[k]}, {p.nx[k], p.ny[k], p.nz[k]}};
      const float distance = (points[i].position - second.position).norm();
      if (distance <= 0) continue;
      const PairFeature f = quantiser.feature(points[i], second, distance);
      EXPECT_NEAR(batch.distance[k], f.distance, 1e-3f);
      EXPECT_NEAR(batch.angle_reference[k], f.angle_reference, 2e-3f);
      EXPECT_NEAR(batch.angle_second[k], f.angle_second, 2e-3f);
      EXPECT_NEAR(batch.angle_normals[k], f.angle_normals, 2e-3f);
      const int turn =
          static_cast<int16_t>(static_cast<uint16_t>(batch.alpha[k]) - frame.alpha(second.position));
      EXPECT_LE(std::abs(turn), 3);
    }
  }
}

class Voting : public testing::TestWithParam<uint64_t> {};

TEST_P(Voting, ReferencesOnTheObjectVoteForItsPose) {
  const fixtures::Sampled seen(GetParam());
  const auto d = static_cast<float>(bracket_model().diameter());
  std::vector<uint32_t> references(seen.points.size());
  std::iota(references.begin(), references.end(), 0u);
  const auto poses = vote(bracket_model(), seen.points, PartnerSearch(seen.points, d), references, {}, 2);
  ASSERT_EQ(poses.size(), references.size() * 4);
  size_t right = 0;
  for (size_t i = 0; i < poses.size(); i += 4) {
    EXPECT_GE(poses[i].votes, poses[i + 1].votes);
    const PoseF pose = {poses[i].rotation, poses[i].translation};
    EXPECT_NEAR(pose.rotation.determinant(), 1, 1e-4);
    right += seen.distance(pose) < 0.1 * d && seen.angle(pose) < 0.35;
  }
  EXPECT_GT(right, references.size() / 20) << "of " << references.size();
}

TEST_P(Voting, NoPartnerNoVote) {
  const std::vector<OrientedPoint> lonely = {{{0, 0, 1}, {0, 0, -1}}, {{3, 0, 1}, {0, 0, -1}}};
  for (const PoseHypothesis& h : vote(bracket_model(), lonely, PartnerSearch(lonely, 0.1f), {0, 1}, {}, 1))
    EXPECT_EQ(h.votes, 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Voting, testing::Values(1, 2, 3));

}  // namespace
}  // namespace edgepose
