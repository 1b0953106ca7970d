#include "matcher/linkage.h"

#include <gtest/gtest.h>

#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

/// The same by comparing all with all, again and again.
std::vector<uint32_t> link_slowly(const std::vector<Eigen::Vector3f>& points, float link) {
  std::vector<uint32_t> cluster(points.size(), ~0u);
  uint32_t count = 0;
  for (size_t seed = 0; seed < points.size(); ++seed) {
    if (cluster[seed] != ~0u) continue;
    std::vector<size_t> open = {seed};
    cluster[seed] = count;
    while (!open.empty()) {
      const size_t at = open.back();
      open.pop_back();
      for (size_t k = 0; k < points.size(); ++k)
        if (cluster[k] == ~0u && (points[k] - points[at]).squaredNorm() < link * link)
          cluster[k] = count, open.push_back(k);
    }
    ++count;
  }
  return cluster;
}

class Linkage : public testing::TestWithParam<uint64_t> {};

TEST_P(Linkage, ClustersAreThoseThatComparingAllGives) {
  fixtures::Random random(GetParam());
  for (const float link : {0.02f, 0.05f, 0.08f, 0.3f}) {
    std::vector<Eigen::Vector3f> points;
    for (int strand = 0; strand < 20; ++strand) {  // edges are lines, some of which touch
      Eigen::Vector3d at = random.vector(0.4);
      const Eigen::Vector3d along = random.direction();
      for (int i = 0; i < 20; ++i) points.push_back((at += random.uniform(0, 0.03) * along).cast<float>());
    }
    EXPECT_EQ(link_clusters(points, link), link_slowly(points, link)) << "link " << link;
  }
}

TEST(Linkage, NoPointsAndOnePointAndCoincidentPoints) {
  EXPECT_TRUE(link_clusters({}, 0.1f).empty());
  EXPECT_EQ(link_clusters({{1, 2, 3}}, 0.1f), std::vector<uint32_t>{0});
  EXPECT_EQ(link_clusters({{1, 2, 3}, {5, 2, 3}, {1, 2, 3}}, 0.1f), (std::vector<uint32_t>{0, 1, 0}));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Linkage, testing::Range<uint64_t>(1, 6));

}  // namespace
}  // namespace edgepose
