/// Detection, tracking, loss and deadline over a moving scene.
#include "server/frame_answer.h"

#include <gtest/gtest.h>

#include "files/mesh_file.h"
#include "tests/service/moving_scene.h"

namespace edgepose {
namespace {

using test::TrueFrame;

ModelHandle phantom() {
  static const ModelHandle model = [] {
    RegisteredModel m{"phantom", train_model(read_mesh(test::phantom_file("phantom.ply")), "phantom")};
    m.content_hash = 1;
    return std::make_shared<const RegisteredModel>(std::move(m));
  }();
  return model;
}

const std::vector<TrueFrame>& scene() {
  static const auto frames = test::moving_phantom(12);
  return frames;
}

bool found(const FrameAnswer& answer, size_t model = 0) {
  const auto& detections = answer.models.at(model).result.detections;
  return !detections.empty() && detections.front().accepted;
}

double error(const FrameAnswer& answer, const TrueFrame& frame) {
  return test::distance(answer.models[0].result.detections.at(0).camera_T_model, frame.camera_T_model,
                        phantom()->model.centre());
}

DepthFrame blind(const TrueFrame& frame) {
  DepthFrame copy = frame.depth;
  copy.image.depth.assign(copy.image.depth.size(), 1.f);  // a wall: measured, and nothing there
  return copy;
}

TEST(FrameAnswer, DetectsOnceThenTracks) {
  FrameAnswerer answerer;
  for (size_t i = 0; i < scene().size(); ++i) {
    const FrameAnswer answer = answerer.answer(scene()[i].depth, {phantom()}, {});
    ASSERT_TRUE(found(answer)) << i << ": " << answer.models[0].result.reason;
    EXPECT_EQ(answer.models[0].mode, i == 0 ? AnswerMode::kDetection : AnswerMode::kTracking) << i;
    EXPECT_LT(error(answer, scene()[i]), 0.001) << i;
  }
}

TEST(FrameAnswer, TrackingIsAsRightAsDetection) {
  FrameAnswerer tracking, detecting;
  AnswerOptions never;
  never.tracking.enabled = false;
  double tracked = 0, detected = 0;
  for (const TrueFrame& frame : scene()) {
    tracked += error(tracking.answer(frame.depth, {phantom()}, {}), frame);
    const FrameAnswer answer = detecting.answer(frame.depth, {phantom()}, never);
    EXPECT_EQ(answer.models[0].mode, AnswerMode::kDetection);
    detected += error(answer, frame);
  }
  EXPECT_LT(tracked, 1.5 * detected);
}

TEST(FrameAnswer, DetectsAgainWhenItJumps) {
  FrameAnswerer answerer;
  answerer.answer(scene()[0].depth, {phantom()}, {});
  // From here on the phantom is elsewhere: 50 mm away and turned.
  TrueFrame jumped = test::moving_phantom(40, 0.02).back();
  jumped.depth.sequence = 2;
  const FrameAnswer answer = answerer.answer(jumped.depth, {phantom()}, {});
  ASSERT_TRUE(found(answer)) << answer.models[0].result.reason;
  EXPECT_EQ(answer.models[0].mode, AnswerMode::kDetection);
  EXPECT_EQ(answer.tracks_lost, 1);
  EXPECT_LT(error(answer, jumped), 0.002);
}

TEST(FrameAnswer, SaysWhatIsLostAndFindsItAgain) {
  FrameAnswerer answerer;
  answerer.answer(scene()[0].depth, {phantom()}, {});
  const FrameAnswer nothing = answerer.answer(blind(scene()[1]), {phantom()}, {});
  EXPECT_FALSE(found(nothing));
  EXPECT_FALSE(nothing.models[0].result.reason.empty());
  const FrameAnswer again = answerer.answer(scene()[2].depth, {phantom()}, {});
  ASSERT_TRUE(found(again));
  EXPECT_EQ(again.models[0].mode, AnswerMode::kDetection);
}

TEST(FrameAnswer, SearchesTheWholeImageFromTimeToTime) {
  FrameAnswerer answerer;
  AnswerOptions options;
  options.tracking.detect_every = 4;
  std::vector<AnswerMode> modes;
  for (const TrueFrame& frame : scene())
    modes.push_back(answerer.answer(frame.depth, {phantom()}, options).models[0].mode);
  for (size_t i = 0; i < modes.size(); ++i)
    EXPECT_EQ(modes[i], i % 4 == 0 ? AnswerMode::kDetection : AnswerMode::kTracking) << i;
}

/// Options with which a search of the whole image does not find the phantom: from so few points, chosen where
/// it is not, that no pose comes up.
AnswerOptions blind_search(int references, double deadline) {
  AnswerOptions options;
  options.match.voting.min_references = options.match.voting.max_references = references;
  options.match.search.batch = 1;
  options.tracking.detect_every = 1;
  options.deadline = deadline;
  for (options.match.seed = 1; options.match.seed < 100; ++options.match.seed)
    if (!found(FrameAnswerer().answer(scene()[1].depth, {phantom()}, options))) return options;
  ADD_FAILURE() << "no seed chooses points beside the phantom only";
  return options;
}

/// A search that looked everywhere and does not find it outweighs that it could be followed.
TEST(FrameAnswer, ASearchThatFindsNothingEndsATrack) {
  FrameAnswerer answerer;
  answerer.answer(scene()[0].depth, {phantom()}, {});
  const FrameAnswer rejected = answerer.answer(scene()[1].depth, {phantom()}, blind_search(1, 0));
  EXPECT_EQ(rejected.models[0].mode, AnswerMode::kDetection);
  EXPECT_FALSE(found(rejected));
  EXPECT_EQ(rejected.tracks_corrected, 1);
  EXPECT_EQ(answerer.answer(scene()[2].depth, {phantom()}, {}).models[0].mode, AnswerMode::kDetection);
}

/// ... but not one that the deadline cut short.
TEST(FrameAnswer, ASearchThatWasCutShortDoesNotEndATrack) {
  FrameAnswerer answerer;
  answerer.answer(scene()[0].depth, {phantom()}, {});
  const FrameAnswer kept = answerer.answer(scene()[1].depth, {phantom()}, blind_search(600, 1e-5));
  EXPECT_EQ(kept.models[0].mode, AnswerMode::kTracking);
  EXPECT_TRUE(found(kept));
  EXPECT_TRUE(kept.deadline_reached);
}

TEST(FrameAnswer, AFollowedPoseKeepsTheMarginOfItsDetection) {
  FrameAnswerer answerer;
  const FrameAnswer detected = answerer.answer(scene()[0].depth, {phantom()}, {});
  const FrameAnswer followed = answerer.answer(scene()[1].depth, {phantom()}, {});
  ASSERT_EQ(followed.models[0].mode, AnswerMode::kTracking);
  EXPECT_EQ(followed.models[0].result.detections.at(0).margin,
            detected.models[0].result.detections.at(0).margin);
}

/// The same file under two names: each is followed by itself.
TEST(FrameAnswer, EqualModelsOfDifferentNames) {
  auto twin = std::make_shared<RegisteredModel>(*phantom());
  twin->name = "twin";
  FrameAnswerer answerer;
  answerer.answer(scene()[0].depth, {phantom()}, {});
  const FrameAnswer answer = answerer.answer(scene()[1].depth, {phantom(), twin}, {});
  EXPECT_EQ(answer.models[0].mode, AnswerMode::kTracking);
  EXPECT_EQ(answer.models[1].mode, AnswerMode::kDetection);
}

TEST(FrameAnswer, AfterALongGapItDetects) {
  FrameAnswerer answerer;
  answerer.answer(scene()[0].depth, {phantom()}, {});
  DepthFrame late = scene()[1].depth;
  late.sequence = 100;
  EXPECT_EQ(answerer.answer(late, {phantom()}, {}).models[0].mode, AnswerMode::kDetection);
}

TEST(FrameAnswer, SameBitsAtOneAndTwoThreads) {
  FrameAnswerer one, two;
  AnswerOptions single, pair;
  single.match.threads = single.scene.threads = 1;
  pair.match.threads = pair.scene.threads = 2;
  for (const TrueFrame& frame : scene()) {
    const FrameAnswer a = one.answer(frame.depth, {phantom()}, single);
    const FrameAnswer b = two.answer(frame.depth, {phantom()}, pair);
    EXPECT_EQ(a.models[0].result.detections[0].camera_T_model.matrix(),
              b.models[0].result.detections[0].camera_T_model.matrix());
    EXPECT_EQ(a.models[0].result.detections[0].score, b.models[0].result.detections[0].score);
  }
}

TEST(FrameAnswer, TheDeadlineLeavesModelsOutInTurn) {
  auto second = std::make_shared<RegisteredModel>(*phantom());
  second->name = "again", second->content_hash = 2;
  FrameAnswerer answerer;
  AnswerOptions options;
  options.deadline = 1e-4;
  options.tracking.enabled = false;
  const ModelList models = {phantom(), second};
  for (size_t i = 0; i < 3; ++i) {
    const FrameAnswer answer = answerer.answer(scene()[i].depth, models, options);
    EXPECT_TRUE(answer.deadline_reached);
    EXPECT_EQ(answer.models[i % 2].mode, AnswerMode::kDetection) << "what was left out comes first";
    EXPECT_EQ(answer.models[(i + 1) % 2].mode, AnswerMode::kSkipped);
    EXPECT_FALSE(answer.models[(i + 1) % 2].result.reason.empty());
  }
  options.deadline = 0;
  EXPECT_FALSE(answerer.answer(scene()[4].depth, models, options).deadline_reached);
}

TEST(FrameAnswer, NothingInRangeIsAReasonNotAFailure) {
  FrameAnswerer answerer;
  DepthFrame far = scene()[0].depth;
  far.image.depth.assign(far.image.depth.size(), 50.f);
  const FrameAnswer answer = answerer.answer(far, {phantom()}, {});
  EXPECT_FALSE(found(answer));
  EXPECT_NE(answer.models[0].result.reason.find("found none"), std::string::npos);
}

TEST(FrameAnswer, WithoutModelsThereIsNothingToSay) {
  EXPECT_TRUE(FrameAnswerer().answer(scene()[0].depth, {}, {}).models.empty());
}

}  // namespace
}  // namespace edgepose
