/// Training, preprocessing and matching with more threads than cores: the same bits, and for the thread
/// sanitizer every place where threads work together. A program of its own, so that the sanitizer need not
/// build the other tests.
#include <gtest/gtest.h>

#include <cstring>

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

}  // namespace
}  // namespace edgepose
