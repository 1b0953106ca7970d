/// Training, preprocessing and matching with more threads than cores: the same bits, and for the thread
/// sanitizer every place where threads work together. A program of its own, so that the sanitizer need not
/// build the other tests.
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <latch>
#include <thread>

#include "matcher/match.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

MatchResult match_with(int threads, Verification verification) {
  fixtures::Random random(1);
  const RigidTransform truth = fixtures::pose_on_table(fixtures::bracket(), fixtures::table(), random);
  SceneOptions scene;
  scene.threads = threads;
  MatchOptions options;
  options.threads = threads;
  options.verification = verification;
  options.max_instances = 2;
  const DepthImage image = fixtures::render(fixtures::table(), fixtures::bracket(), truth);
  return match(prepare_scene(image, fixtures::kCamera, scene), fixtures::bracket_model(), options);
}

TEST(Threads, TrainTheSameModel) {
  const Model one = train_model(fixtures::bracket(), "bracket", fixtures::quick_training(1)),
              four = train_model(fixtures::bracket(), "bracket", fixtures::quick_training(4));
  ASSERT_EQ(one.block().size(), four.block().size());
  EXPECT_EQ(std::memcmp(one.block().data(), four.block().data(), one.block().size()), 0);
}

TEST(Threads, FindTheSamePoseInEveryMode) {
  for (const auto mode : {Verification::kFreeSpace, Verification::kPaper, Verification::kSurfaceOverlap}) {
    const MatchResult one = match_with(1, mode), four = match_with(4, mode);
    ASSERT_FALSE(one.detections.empty());
    ASSERT_EQ(one.detections.size(), four.detections.size());
    EXPECT_EQ(one.detections[0].camera_T_model.matrix(), four.detections[0].camera_T_model.matrix());
    EXPECT_EQ(one.detections[0].score, four.detections[0].score);
    EXPECT_EQ(one.detections[0].covariance, four.detections[0].covariance);
  }
}

/// A scene is safe from any thread, though it keeps the samples that matches make.
TEST(Threads, AskOneSceneAtTheSameTime) {
  fixtures::Random random(1);
  const RigidTransform truth = fixtures::pose_on_table(fixtures::bracket(), fixtures::table(), random);
  const DepthImage image = fixtures::render(fixtures::table(), fixtures::bracket(), truth);
  Mesh larger = fixtures::bracket();
  for (Eigen::Vector3f& vertex : larger.vertices) vertex *= 1.5f;
  const Model other = train_model(larger, "larger", fixtures::quick_training(2));
  const std::array<const Model*, 3> asked = {&fixtures::bracket_model(), &other, &fixtures::bracket_model()};
  const Scene shared = prepare_scene(image, fixtures::kCamera);
  std::array<MatchResult, asked.size()> together;
  std::latch all(asked.size());
  std::vector<std::thread> threads;
  for (size_t i = 0; i < asked.size(); ++i)
    threads.emplace_back([&, i] {
      MatchOptions options;
      options.threads = 2;
      all.arrive_and_wait();
      together[i] = match(shared, *asked[i], options);
    });
  for (std::thread& thread : threads) thread.join();
  for (size_t i = 0; i < asked.size(); ++i) {
    const MatchResult alone = match(prepare_scene(image, fixtures::kCamera), *asked[i]);
    ASSERT_FALSE(alone.detections.empty());
    ASSERT_EQ(together[i].detections.size(), alone.detections.size());
    EXPECT_EQ(together[i].detections[0].camera_T_model.matrix(), alone.detections[0].camera_T_model.matrix());
    EXPECT_EQ(together[i].detections[0].score, alone.detections[0].score);
  }
}

}  // namespace
}  // namespace edgepose
