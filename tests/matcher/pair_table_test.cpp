#include "matcher/pair_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <stdexcept>

#include "tests/matcher/solids.h"

namespace edgepose {
namespace {

constexpr float kRadians = std::numbers::pi_v<float> / 180;

struct Input {
  std::vector<OrientedPoint> points;
  FeatureQuantiser quantiser;
  PairFilter filter;
};

/// Points with normals in all directions, all of which some view shows together.
Input random_input(uint64_t seed, float min_deg, float max_deg) {
  fixtures::Random random(seed);
  Input input;
  for (int i = 0; i < 150; ++i)
    input.points.push_back({random.vector(0.05).cast<float>(), random.direction().cast<float>()});
  // Also normals that differ by just about the filter's angles.
  for (int i = 0; i < 150; ++i) {
    const OrientedPoint like = input.points[i];
    const Eigen::AngleAxisf turn(static_cast<float>(random.uniform(3, 7)) * kRadians,
                                 like.normal.unitOrthogonal());
    const Eigen::Vector3f normal = turn * like.normal;
    input.points.push_back({random.vector(0.05).cast<float>(), i % 2 ? normal : Eigen::Vector3f(-normal)});
  }
  input.quantiser = {1 / 0.01f, 15 / std::numbers::pi_v<float>, 21, 15};
  input.filter = {min_deg * kRadians, max_deg * kRadians, {}};
  input.filter.seen_from.assign(input.points.size(), {1});
  return input;
}

size_t pairs_between(const std::vector<OrientedPoint>& points, double min_deg, double max_deg) {
  size_t pairs = 0;
  for (size_t i = 0; i < points.size(); ++i)
    for (size_t k = 0; k < points.size(); ++k) {
      const double cosine = points[i].normal.cast<double>().dot(points[k].normal.cast<double>());
      const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) * 180 / std::numbers::pi;
      pairs += i != k && angle >= min_deg && angle <= max_deg;
    }
  return pairs;
}

TEST(BuildPairTable, FiltersByTheAngleItself) {
  for (const auto& [low, high] : {std::pair{0, 180}, {5, 175}, {4, 176}, {12, 168}, {30, 90}}) {
    const Input in = random_input(1, static_cast<float>(low), static_cast<float>(high));
    const PairTable table = build_pair_table(in.points, in.quantiser, in.filter, 2);
    // The arc cosine of the features is off by up to 0.004 degrees.
    EXPECT_GE(table.entries.size(), pairs_between(in.points, low + 0.006, high - 0.006))
        << low << " " << high;
    EXPECT_LE(table.entries.size(), pairs_between(in.points, low - 0.006, high + 0.006))
        << low << " " << high;
    const auto [first, last] = normal_bins(in.filter, in.quantiser);
    for (uint32_t bucket = 0; bucket < in.quantiser.bucket_count(); ++bucket) {
      const uint32_t normals = bucket / (15 * 15) % 15;
      const bool empty = table.offsets[bucket] == table.offsets[bucket + 1];
      ASSERT_TRUE(empty || (normals >= first && normals <= last)) << "the scene would never look there";
    }
  }
}

TEST(EstimateTable, IsNearTheTruth) {
  const Input in = random_input(2, 5, 175);
  const PairTable table = build_pair_table(in.points, in.quantiser, in.filter, 1);
  const TableSize size = estimate_table(in.points, in.quantiser, in.filter);
  EXPECT_EQ(size.bucket_bytes, static_cast<double>(table.offsets.size() * sizeof(uint32_t)));
  EXPECT_NEAR(size.pair_bytes / static_cast<double>(table.entries.size() * sizeof(PairEntry)), 1, 0.05);
}

TEST(TrainModel, TheAngleFilterChangesTheTable) {
  TrainOptions options = fixtures::quick_training();
  options.min_normal_angle_deg = 0, options.max_normal_angle_deg = 180;
  const size_t all = train_model(fixtures::bracket(), "bracket", options).pair_count();
  options.min_normal_angle_deg = 5, options.max_normal_angle_deg = 175;
  const size_t filtered = train_model(fixtures::bracket(), "bracket", options).pair_count();
  EXPECT_LT(filtered, all * 97 / 100) << "a bracket's faces are planes";
}

TEST(TrainModel, RefusesATableThatIsTooLarge) {
  const auto refusal = [](const auto& change) -> std::string {
    TrainOptions options = fixtures::quick_training();
    change(options);
    try {
      train_model(fixtures::bracket(), "bracket", options);
      return "";
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
  };
  EXPECT_THAT(refusal([](auto& o) { o.distance_step = 0.005f, o.angle_step_deg = 2; }),
              testing::AllOf(testing::StartsWith("angle_step_deg"), testing::HasSubstr("256 MB"),
                             testing::HasSubstr("found about 5")));
  EXPECT_THAT(
      refusal([](auto& o) { o.sampling_step = 0.015f, o.max_table_mb = 20; }),
      testing::AllOf(testing::StartsWith("sampling_step"), testing::HasSubstr("max_table_mb = 20 MB")));
  EXPECT_EQ(refusal([](auto& o) { o.max_table_mb = 4; }), "");
}

TEST(TrainOptions, CheckKnowsEveryField) {
  const auto fault = [](const auto& change) {
    TrainOptions options;
    change(options);
    return options.check();
  };
  for (int bad : {-1, -1000})
    EXPECT_THAT(fault([&](auto& o) { o.threads = bad; }), testing::StartsWith("threads"));
  for (int bad : {0, -5, 5000})
    EXPECT_THAT(fault([&](auto& o) { o.max_table_mb = bad; }), testing::StartsWith("max_table_mb"));
  EXPECT_THAT(fault([](auto& o) { o.min_normal_angle_deg = -std::numeric_limits<float>::infinity(); }),
              testing::StartsWith("min_normal_angle_deg"));
}

TEST(TrainModel, DeclaredSymmetriesReplaceThoseFound) {
  const Mesh bar = fixtures::box(0.03, 0.05, 0.08);
  TrainOptions options = fixtures::quick_training();
  EXPECT_EQ(train_model(bar, "bar", options).symmetries().discrete.size(), 3u);
  Symmetries declared;
  declared.discrete.push_back(RigidTransform(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ())));
  const Symmetries kept = train_model(bar, "bar", options, declared).symmetries();
  ASSERT_EQ(kept.discrete.size(), 1u);
  EXPECT_TRUE(kept.discrete[0].isApprox(declared.discrete[0]));
}

TEST(FromBlock, TheChecksumCoversTheHeadOfTheFile) {
  const auto good = fixtures::bracket_model().block();
  const auto refusal = [&](size_t at, uint32_t value) -> std::string {
    std::vector<std::byte> bytes(good.begin(), good.end());
    std::memcpy(bytes.data() + at, &value, sizeof(value));
    try {
      Model::from_block(bytes, nullptr);
      return "";
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
  };
  const uint32_t bins = fixtures::bracket_model().view().header->distance_bins;
  EXPECT_THAT(refusal(offsetof(ModelHeader, distance_bins), bins ^ 2), testing::HasSubstr("checksum"));
  EXPECT_THAT(refusal(offsetof(ModelHeader, version), 1),
              testing::AllOf(testing::HasSubstr("version 1"), testing::HasSubstr("train")));
}

TEST(LargestDistance, IsThatOfAllPairs) {
  fixtures::Random random(6);
  for (int round = 0; round < 5; ++round) {
    std::vector<OrientedPoint> points;
    const size_t count = 1 + random.below(1500);  // not in whole blocks
    for (size_t i = 0; i < count; ++i)
      points.push_back(
          {random.vector(0.1).cwiseProduct(Eigen::Vector3d(1, 2, 0.3)).cast<float>(), {0, 0, 1}});
    float most = 0;
    for (const auto& a : points)
      for (const auto& b : points) most = std::max(most, (a.position - b.position).norm());
    EXPECT_NEAR(largest_distance(points), most, 0.001f * most);
  }
}

}  // namespace
}  // namespace edgepose
