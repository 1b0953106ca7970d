#include "matcher/free_space.h"

#include <gtest/gtest.h>

#include "tests/matcher/search_fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket_model;

class FreeSpace : public testing::TestWithParam<uint64_t> {
 protected:
  FreeSpace() : seen(GetParam()), options(settings()) {}

  FreeSpaceOptions settings() const {
    const std::vector<OrientedPoint> none;
    const MatchOptions defaults;
    return CandidateSearch(seen.scene->data(), bracket_model(), none, defaults).settings(seen.truth()).full;
  }
  FreeSpaceEvidence examine(const DepthImage& image, const PoseF& pose) const {
    PosedSurface surface;
    return examine_pose(prepare_scene(image, fixtures::kCamera).data(), bracket_model().view(), pose, options,
                        surface);
  }

  fixtures::Sampled seen;
  FreeSpaceOptions options;
};

TEST_P(FreeSpace, TheTruePoseIsMatchedAndNotViolated) {
  const FreeSpaceEvidence e = examine(seen.image, seen.truth());
  EXPECT_GT(e.expected, 200);
  EXPECT_GT(e.coverage(), 0.8);
  EXPECT_LT(e.violation_share(), 0.02);
  EXPECT_GT(acceptance_score(e, options, 1), 0.66);
}

TEST_P(FreeSpace, WhereTheTableShowsThroughThePoseIsViolated) {
  const FreeSpaceEvidence e = examine(fixtures::render(fixtures::table()), seen.truth());
  EXPECT_GT(e.violation_share(), 0.4);
  EXPECT_LT(acceptance_score(e, options, 1), 0.2);
}

TEST_P(FreeSpace, AnOccluderHidesAndDoesNotViolate) {
  DepthImage image = seen.image;
  const FreeSpaceEvidence before = examine(image, seen.truth());
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width / 2; ++u) image.at(u, v) = 0.15f;
  const FreeSpaceEvidence e = examine(image, seen.truth());
  EXPECT_GT(e.occluded, before.occluded + 50);
  EXPECT_LT(e.matched, before.matched - 50);
  EXPECT_LT(e.violation_share(), 0.02);
}

TEST_P(FreeSpace, TheTruePoseRanksAboveItsNeighbours) {
  fixtures::Random random(GetParam() + 7);
  const float d = static_cast<float>(bracket_model().diameter());
  const float best = rank_score(examine(seen.image, seen.truth()), options);
  for (int i = 0; i < 10; ++i)
    EXPECT_GT(best, rank_score(examine(seen.image, seen.perturbed(random, 0.4, 0.1 * d)), options));
}

INSTANTIATE_TEST_SUITE_P(Seeds, FreeSpace, testing::Values(1, 2, 3));

TEST(Score, OfNothingSeenIsLowest) {
  EXPECT_EQ(rank_score({}, {}), kNoEvidence);
  EXPECT_EQ(surface_score({}, {}), kNoEvidence);
  EXPECT_EQ(acceptance_score({}, {}, 1), 0);
}

}  // namespace
}  // namespace edgepose
