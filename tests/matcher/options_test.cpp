#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "matcher/match.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// check() of the defaults with one field changed.
template <typename Options, typename Change>
std::string fault(const Change& change) {
  Options options;
  change(options);
  return options.check();
}

TEST(Options, DefaultsAreSound) {
  EXPECT_EQ(TrainOptions{}.check(), "");
  EXPECT_EQ(SceneOptions{}.check(), "");
  EXPECT_EQ(MatchOptions{}.check(), "");
}

TEST(Options, TrainOptionsNameTheBadField) {
  for (float bad : {0.f, -1.f, 0.5f, kNan}) {
    EXPECT_THAT(fault<TrainOptions>([&](auto& o) { o.sampling_step = bad; }),
                testing::StartsWith("sampling_step"));
    EXPECT_THAT(fault<TrainOptions>([&](auto& o) { o.distance_step = bad; }),
                testing::StartsWith("distance_step"));
    EXPECT_THAT(fault<TrainOptions>([&](auto& o) { o.angle_step_deg = bad; }),
                testing::StartsWith("angle_step_deg"));
  }
  EXPECT_THAT(fault<TrainOptions>([](auto& o) { o.min_normal_angle_deg = 176; }),
              testing::HasSubstr("min_normal_angle_deg"));
  EXPECT_THAT(fault<TrainOptions>([](auto& o) { o.max_normal_angle_deg = kNan; }),
              testing::HasSubstr("max_normal_angle_deg"));
  EXPECT_THAT(fault<TrainOptions>([](auto& o) { o.views = 0; }), testing::StartsWith("views"));
  EXPECT_THAT(fault<TrainOptions>([](auto& o) { o.views = 1000000; }), testing::StartsWith("views"));
  TrainOptions bad;
  bad.views = -1;
  EXPECT_THROW(train_model(fixtures::bracket(), "bracket", bad), std::invalid_argument);
}

TEST(Options, SceneOptionsNameTheBadField) {
  EXPECT_THAT(fault<SceneOptions>([](auto& o) { o.min_depth = 0; }), testing::HasSubstr("min_depth"));
  EXPECT_THAT(fault<SceneOptions>([](auto& o) { o.min_depth = 20; }), testing::HasSubstr("min_depth"));
  EXPECT_THAT(fault<SceneOptions>([](auto& o) { o.max_depth = kNan; }), testing::HasSubstr("max_depth"));
}

TEST(Options, MatchOptionsNameTheBadField) {
  for (float bad : {-0.1f, 1.1f, kNan}) {
    EXPECT_THAT(fault<MatchOptions>([&](auto& o) { o.voting.reference_share = bad; }),
                testing::StartsWith("voting.reference_share"));
    EXPECT_THAT(fault<MatchOptions>([&](auto& o) { o.sampling.theta_factor = bad; }),
                testing::StartsWith("sampling.theta_factor"));
    EXPECT_THAT(fault<MatchOptions>([&](auto& o) { o.clustering.max_distance = bad; }),
                testing::StartsWith("clustering.max_distance"));
    EXPECT_THAT(fault<MatchOptions>([&](auto& o) { o.tolerance.surface = bad; }),
                testing::StartsWith("tolerance.surface"));
    EXPECT_THAT(fault<MatchOptions>([&](auto& o) { o.paper.edge_distance = bad; }),
                testing::StartsWith("paper.edge_distance"));
    EXPECT_THAT(fault<MatchOptions>([&](auto& o) { o.accept_score = bad; }),
                testing::StartsWith("accept_score"));
  }
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.search.batch = 0; }), testing::StartsWith("search.batch"));
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.search.fine_candidates = o.search.coarse_candidates + 1; }),
              testing::StartsWith("search.fine_candidates"));
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.refinement.fine_iterations = -1; }),
              testing::StartsWith("refinement.fine_iterations"));
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.threads = -3; }), testing::StartsWith("threads"));
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.max_instances = 0; }),
              testing::StartsWith("max_instances"));
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.paper.candidates = 0; }),
              testing::StartsWith("paper.candidates"));
  EXPECT_THAT(fault<MatchOptions>([](auto& o) { o.paper.roi_scale = kNan; }),
              testing::StartsWith("paper.roi_scale"));
}

}  // namespace
}  // namespace edgepose
