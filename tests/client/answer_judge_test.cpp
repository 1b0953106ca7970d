#include "client/service/answer_judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "tests/client/fake_service.h"

namespace edgepose {
namespace {

using test::answer_with;
using testing::ElementsAre;
using testing::Pair;

constexpr int64_t kNow = 1'700'000'000'000'000;

ReceivedMessage received(const std::string& channel, const std::vector<std::byte>& bytes) {
  ReceivedMessage message{channel, std::make_unique<std::byte[]>(bytes.size()), bytes.size()};
  std::memcpy(message.bytes.get(), bytes.data(), bytes.size());
  return message;
}

/// `waited`: [us] between the frame and its answer.
std::vector<std::byte> sent_at(int64_t utime, int64_t waited = 0) {
  auto answer = answer_with("camera", 1, 0.1);
  answer.send_utime = utime;
  answer.capture_utime = utime - waited;
  return encode(answer);
}

TEST(AnswerJudge, WithAKeyOnlyWhatItsHolderSentJustNow) {
  const SecretKey key = SecretKey::random();
  MessageSigner signer(key, 1), stranger(SecretKey::random(), 1);
  AnswerJudge judge(key, 5);
  edgepose_lcm::pose_estimates_t answer;
  auto genuine = sent_at(kNow), old = sent_at(kNow - 6'000'000), altered = sent_at(kNow);
  signer.sign(channels::kPoses, genuine);
  signer.sign(channels::kPoses, old);
  stranger.sign(channels::kPoses, altered);
  EXPECT_FALSE(judge.take(received(channels::kPoses, sent_at(kNow)), kNow, answer));
  EXPECT_FALSE(judge.take(received(channels::kPoses, altered), kNow, answer));
  EXPECT_TRUE(judge.take(received(channels::kPoses, genuine), kNow, answer));
  EXPECT_FALSE(judge.take(received(channels::kPoses, genuine), kNow, answer));
  EXPECT_FALSE(judge.take(received(channels::kPoses, old), kNow, answer));
  EXPECT_THAT(judge.refused(),
              ElementsAre(Pair("altered", 1), Pair("old", 1), Pair("replayed", 1), Pair("unsigned", 1)));
}

TEST(AnswerJudge, AFreshAnswerToAnOldFrameIsOld) {
  const SecretKey key = SecretKey::random();
  MessageSigner signer(key, 1);
  AnswerJudge judge(key, 5);
  edgepose_lcm::pose_estimates_t answer;
  auto stale = sent_at(kNow, 6'000'000), ahead = sent_at(kNow + 3'000'000);
  signer.sign(channels::kPoses, stale);
  signer.sign(channels::kPoses, ahead);
  EXPECT_FALSE(judge.take(received(channels::kPoses, stale), kNow, answer));
  EXPECT_FALSE(judge.take(received(channels::kPoses, ahead), kNow, answer));
  EXPECT_THAT(judge.refused(), ElementsAre(Pair("from_the_future", 1), Pair("old", 1)));
}

TEST(AnswerJudge, WithoutAKeyWhateverIsSound) {
  AnswerJudge judge(std::nullopt, 5);
  EXPECT_FALSE(judge.verifies());
  edgepose_lcm::pose_estimates_t answer;
  edgepose_lcm::service_status_t status;
  EXPECT_TRUE(judge.take(received(channels::kPoses, sent_at(0)), kNow, answer));
  EXPECT_FALSE(judge.take(received(channels::kPoses, std::vector<std::byte>(30)), kNow, answer));
  EXPECT_FALSE(judge.take(received(channels::kStatus, std::vector<std::byte>(30)), status));
  auto nonsense = answer_with("camera", 1, 0.1);
  nonsense.answers[0].detections[0].camera_T_model.quaternion[0] = 2;
  EXPECT_FALSE(judge.take(received(channels::kPoses, encode(nonsense)), kNow, answer));
  nonsense = answer_with("camera", 1, 0.1);
  nonsense.answers[0].detections[0].camera_T_model.translation[0] = std::nan("");
  EXPECT_FALSE(judge.take(received(channels::kPoses, encode(nonsense)), kNow, answer));
  edgepose_lcm::drill_targets_t targets{};
  targets.targets.resize(1);
  targets.targets_count = 1;
  targets.targets[0].entry[2] = std::nan("");
  EXPECT_FALSE(judge.take(received(channels::kDrillTargets, encode(targets)), kNow, targets));
  EXPECT_THAT(judge.refused(), ElementsAre(Pair("malformed", 5)));
}

}  // namespace
}  // namespace edgepose
