#include "matcher/bucket_visits.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "tests/matcher/search_fixtures.h"

namespace edgepose {
namespace {

constexpr FeatureQuantiser kQuantiser = {1 / 0.01f, 15 / std::numbers::pi_v<float>, 20, 15};

/// Random features, also right at borders and beyond the last distance, with the pair's number as alpha.
FeatureBatch random_features(size_t count, fixtures::Random& random) {
  FeatureBatch batch;
  const auto value = [&](int bins) {
    const float v = static_cast<float>(random.uniform(0, bins));
    return random.uniform(0, 1) < 0.1 ? std::floor(v) : v;
  };
  for (size_t i = 0; i < count; ++i) {
    const float distance = value(25);
    batch.distance.push_back(distance);
    batch.squared_distance.push_back(distance * distance * 1e-4f);
    batch.angle_reference.push_back(value(15));
    batch.angle_second.push_back(value(15));
    batch.angle_normals.push_back(value(15));
    batch.alpha.push_back(static_cast<int32_t>(i));
  }
  for (auto* column : {&batch.squared_distance, &batch.distance, &batch.angle_reference, &batch.angle_second,
                       &batch.angle_normals})
    column->resize(count + 7);
  batch.alpha.resize(count + 7);
  return batch;
}

std::set<uint32_t> bins_of(float value, float border, uint32_t size) {
  const uint32_t own = std::min(static_cast<uint32_t>(value), size - 1);
  const float rest = value - static_cast<float>(own);
  if (rest < border && own > 0) return {own, own - 1};
  if (rest > 1 - border && own + 1 < size) return {own, own + 1};
  return {own};
}

std::set<uint32_t> buckets_of(const FeatureBatch& batch, size_t i, const VisitRule& rule) {
  std::set<uint32_t> buckets;
  if (batch.squared_distance[i] > rule.reach * rule.reach || batch.squared_distance[i] <= 0) return buckets;
  for (const uint32_t n : bins_of(batch.angle_normals[i], rule.border, 15)) {
    if (n < rule.normal_bin_first || n > rule.normal_bin_last) continue;
    for (const uint32_t d : bins_of(batch.distance[i], rule.border, 20))
      for (const uint32_t a : bins_of(batch.angle_reference[i], rule.border, 15))
        for (const uint32_t b : bins_of(batch.angle_second[i], rule.border, 15))
          buckets.insert(kQuantiser.bucket(d, a, b, n));
  }
  return buckets;
}

class Visits : public testing::TestWithParam<uint64_t> {};

TEST_P(Visits, EachPairVisitsItsBucketAndTheNeighboursOnceInThePairsOrder) {
  fixtures::Random random(GetParam());
  BucketVisits visits;
  for (const size_t count : {1u, 7u, 8u, 9u, 300u, 11u}) {
    const FeatureBatch batch = random_features(count, random);
    const VisitRule rule = {0.2f, static_cast<float>(random.uniform(0, 0.4)), 2, 11};
    visits.list(batch, count, kQuantiser, rule);
    std::map<uint16_t, std::set<uint32_t>> listed;
    for (size_t i = 0; i < visits.count(); ++i) {
      EXPECT_TRUE(listed[visits.alpha(i)].insert(visits.bucket(i)).second) << "twice";
      EXPECT_LE(visits.alpha(i > 0 ? i - 1 : 0), visits.alpha(i));
    }
    for (size_t i = 0; i < count; ++i)
      EXPECT_EQ(listed[static_cast<uint16_t>(i)], buckets_of(batch, i, rule)) << "pair " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, Visits, testing::Range<uint64_t>(1, 6));

}  // namespace
}  // namespace edgepose
