#include "matcher/scene_samples.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <latch>
#include <new>
#include <thread>

#include "matcher/scene_sampling.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

TEST(SampleScale, CoversWhatItStandsFor) {
  fixtures::Random random(7);
  for (int i = 0; i < 10000; ++i) {
    const auto diameter = static_cast<float>(std::exp(random.uniform(std::log(0.005), std::log(5.))));
    const auto step = diameter * static_cast<float>(random.uniform(0.01, 0.2));
    const SampleScale scale(step, diameter, {});
    EXPECT_NEAR(scale.step_size() / step, 1, 0.0906);
    EXPECT_GE(scale.most_diameter(), diameter * 0.9999f);
    EXPECT_LE(scale.most_diameter(), diameter * 1.42f);
  }
}

TEST(SampleScale, IsSharedByModelsOfLikeSizeAndLikeOptionsOnly) {
  const SampleScale scale(0.0053f, 0.106f, {});
  EXPECT_EQ(scale, SampleScale(0.0056f, 0.112f, {}));
  EXPECT_FALSE(scale == SampleScale(0.0075f, 0.15f, {}));
  SamplingOptions other;
  other.fine_theta_deg = 20;
  EXPECT_FALSE(scale == SampleScale(0.0053f, 0.106f, other));
}

TEST(SampleCache, MakesEachScaleOnceForAllThreads) {
  SampleCache cache;
  std::atomic<int> made = 0;
  std::latch both(2);
  const auto ask = [&] {
    both.arrive_and_wait();
    for (const float d : {0.1f, 0.2f, 0.4f}) {
      const SceneSamples& samples = cache.get(SampleScale(d / 20, d, {}), [&] {
        ++made;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // for the other one to come
        return SceneSamples{std::vector<SampledPoint>(static_cast<size_t>(100 * d)), {}};
      });
      EXPECT_EQ(samples.fine.size(), static_cast<size_t>(100 * d));
    }
  };
  std::thread one(ask), other(ask);
  one.join(), other.join();
  EXPECT_EQ(made, 3);
}

TEST(SampleCache, WhatCouldNotBeMadeIsMadeWhenItIsAskedForAgain) {
  SampleCache cache;
  const SampleScale scale(0.005f, 0.1f, {});
  EXPECT_THROW(cache.get(scale, []() -> SceneSamples { throw std::bad_alloc(); }), std::bad_alloc);
  EXPECT_EQ(cache.get(scale, [] { return SceneSamples{std::vector<SampledPoint>(3), {}}; }).fine.size(), 3u);
}

/// What models of like size asked for before, also with other limits, must change nothing.
TEST(SampleScene, WhatWasAskedForBeforeChangesNothing) {
  fixtures::Random random(9);
  const RigidTransform pose = fixtures::pose_on_table(fixtures::bracket(), fixtures::table(), random);
  const DepthImage image = fixtures::render(fixtures::table(), fixtures::bracket(), pose);
  const auto sample = [](const Scene& scene, float d, float max_pixel_size) {
    SamplingOptions options;
    options.max_pixel_size = max_pixel_size;
    return sample_scene(scene.data(), d / 20, d, options, 2);
  };
  const Scene used = prepare_scene(image, fixtures::kCamera);
  // The table begins at some 0.25 m, where a pixel spans 1 mm: the tighter limit cuts through it.
  for (const float limit : {0.03f, 0.012f}) {
    for (const float d : {0.103f, 0.108f, 0.118f, 0.3f}) sample(used, d, limit);
    for (const float d : {0.105f, 0.112f}) {
      const auto a = sample(used, d, limit), b = sample(prepare_scene(image, fixtures::kCamera), d, limit);
      ASSERT_GT(a.size(), 100u);
      ASSERT_EQ(a.size(), b.size());
      for (size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].surface.position, b[i].surface.position);
        EXPECT_EQ(a[i].surface.normal, b[i].surface.normal);
        EXPECT_EQ(a[i].area, b[i].area);
        EXPECT_EQ(a[i].edge, b[i].edge);
      }
    }
    // Models on the same rung have the same samples, but limits of their own.
    EXPECT_EQ(sample(used, 0.105f, limit).size() < sample(used, 0.112f, limit).size(), limit < 0.02f);
  }
}

}  // namespace
}  // namespace edgepose
