#include "matcher/paper_verification.h"

#include <gtest/gtest.h>

#include "tests/matcher/search_fixtures.h"

namespace edgepose {
namespace {

using fixtures::bracket_model;

class PaperVerification : public testing::TestWithParam<uint64_t> {
 protected:
  PaperVerification()
      : seen(GetParam()),
        d(static_cast<float>(bracket_model().diameter())),
        edges(seen.scene->data(), 0.01f * d, d / 32),
        near_model(bracket_model().view(), 0.02f * d) {}
  float score(const PoseF& pose) const {
    return edge_score(edges, bracket_model().view(), near_model, pose, options);
  }

  fixtures::Sampled seen;
  float d;
  SceneEdges edges;
  NearModel near_model;
  PaperOptions options;
};

TEST_P(PaperVerification, TheTruePoseHasTheHigherScore) {
  fixtures::Random random(GetParam() + 20);
  const float truth = score(seen.truth());
  EXPECT_GT(truth, 0.5);
  EXPECT_LE(truth, 1);
  for (int i = 0; i < 5; ++i) EXPECT_GT(truth, score(seen.perturbed(random, 0.6, 0.15 * d)));
}

TEST_P(PaperVerification, EdgesInABoxAreThoseOfTheWholeImage) {
  const float cell = 0.01f * d, border = 2 * cell;  // a cell that the box cuts may have another first point
  const Eigen::AlignedBox3f box = region_of_interest(bracket_model().view(), seen.truth(), 0.8f);
  const SceneEdges boxed(seen.scene->data(), cell, d / 32, box);
  const Eigen::AlignedBox3f inner(box.min().array() + border, box.max().array() - border);
  const auto within = [&](const SceneEdges& of) {
    std::vector<std::array<float, 3>> points;
    for (const Eigen::Vector3f& p : of.points())
      if (inner.contains(p)) points.push_back({p.x(), p.y(), p.z()});
    std::sort(points.begin(), points.end());
    return points;
  };
  EXPECT_GT(within(edges).size(), 50u);
  EXPECT_EQ(within(boxed), within(edges));
  EXPECT_LT(boxed.points().size(), edges.points().size());
  for (const Eigen::Vector3f& p : boxed.points()) EXPECT_TRUE(box.contains(p));
}

TEST_P(PaperVerification, ChoosesTheTruePoseAmongOthersInAnyClass) {
  fixtures::Random random(GetParam() + 30);
  for (const size_t place : {0u, 3u, 7u}) {
    std::vector<PoseF> poses;
    std::vector<float> votes;
    for (size_t i = 0; i < 8; ++i) {
      poses.push_back(i == place ? seen.truth() : seen.perturbed(random, 0.8, 0.2 * d));
      votes.push_back(100 - 10 * static_cast<float>(i));  // 100 to 30: classes above and below half
    }
    size_t detailed = 0;
    options.early_exit = false;
    EXPECT_EQ(verify_like_the_paper(edges, bracket_model().view(), poses, votes, options, 1, &detailed),
              place);
    EXPECT_EQ(detailed, poses.size());
    options.early_exit = true;
    options.accept_at_once = 0.01f;  // the first that is looked at is good enough
    verify_like_the_paper(edges, bracket_model().view(), poses, votes, options, 1, &detailed);
    EXPECT_LT(detailed, poses.size());
    options = {};
  }
}

TEST_P(PaperVerification, SurfaceOverlapIsHighAtTheTruePose) {
  fixtures::Random random(GetParam() + 40);
  const Scene::Data& scene = seen.scene->data();
  const float truth = surface_overlap(scene, bracket_model().view(), seen.truth(), 0.02f * d);
  EXPECT_GT(truth, 0.3) << "about half of the surface faces away";
  EXPECT_LE(truth, 1);
  EXPECT_GT(truth,
            surface_overlap(scene, bracket_model().view(), seen.perturbed(random, 0.8, 0.3 * d), 0.02f * d));
}

INSTANTIATE_TEST_SUITE_P(Seeds, PaperVerification, testing::Values(1, 2, 3));

}  // namespace
}  // namespace edgepose
