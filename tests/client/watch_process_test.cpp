/// `edgepose watch` over real LCM.
#include <gmock/gmock.h>

#include <csignal>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "tests/client/child.h"
#include "tests/client/fake_service.h"

namespace edgepose::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class WatchProcess : public OnOwnNetwork {
 protected:
  void SetUp() override {
    OnOwnNetwork::SetUp();
    if (!IsSkipped()) bus_.emplace();
  }
  /// Says `message` again and again until the program has heard it.
  void until_heard(const Child& watch, const edgepose_lcm::pose_estimates_t& message) {
    ASSERT_TRUE(eventually([&] {
      bus_->publish(channels::kPoses, encode(message));
      return !watch.out().empty();
    })) << watch.err();
  }
  std::optional<Bus> bus_;  // made when the network is the test's own
  Folder folder_;
};

TEST_F(WatchProcess, OneLineAnAnswerAndASummaryOnCtrlC) {
  Child watch(program({"watch"}));
  until_heard(watch, answer_with("camera", 42, 0.123));
  watch.signal(SIGINT);
  const Finished run = watch.wait();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("camera 42, "));
  EXPECT_THAT(run.out, HasSubstr("part at (123.00, 0.00, 500.00) mm score 0.90 by tracking"));
  EXPECT_THAT(run.out, HasSubstr("none verified"));
  EXPECT_THAT(run.err, HasSubstr("nothing that is shown is verified"));
}

TEST_F(WatchProcess, JsonIsOneObjectALine) {
  Child watch(program({"watch", "--json", "--count", "3"}));
  auto answer = answer_with("camera", 7, 0.1);
  answer.dropped.resize(1);
  answer.dropped_count = 1;
  answer.dropped[0].name = "superseded";
  answer.dropped[0].value = 4;
  ASSERT_TRUE(eventually([&] {
    bus_->publish(channels::kPoses, encode(answer));
    return watch.err().find("answers") != std::string::npos;  // its summary
  }));
  const Finished run = watch.wait();
  EXPECT_EQ(run.code, 0) << run.err;
  std::istringstream lines(run.out);
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    const json object = json::parse(line);
    EXPECT_EQ(object.at("type"), "poses");
    EXPECT_EQ(object.at("sequence"), 7);
    EXPECT_EQ(object.at("dropped").at("superseded"), 4);
    EXPECT_EQ(object.at("models").at(0).at("mode"), "tracking");
    EXPECT_DOUBLE_EQ(object.at("models")
                         .at(0)
                         .at("detections")
                         .at(0)
                         .at("camera_T_model")
                         .at("translation_m")
                         .at(0)
                         .get<double>(),
                     0.1);
  }
  EXPECT_EQ(count, 3);
}

TEST_F(WatchProcess, WithAKeyTheRestIsRefusedAndCounted) {
  const SecretKey key = SecretKey::random();
  key.write(folder_ / "key");
  MessageSigner signer(key, utime_now()), stranger(SecretKey::random(), utime_now());
  Child watch(program({"watch", "--key", folder_ / "key", "--count", "2"}));
  auto genuine = [&](int64_t sequence, int64_t age = 0) {
    auto answer = answer_with("camera", sequence, 0.1);
    answer.send_utime -= age;
    auto bytes = encode(answer);
    signer.sign(channels::kPoses, bytes);
    return bytes;
  };
  const auto first = genuine(1);
  ASSERT_TRUE(eventually([&] {
    bus_->publish(channels::kPoses, first);
    return !watch.out().empty();
  })) << watch.err();
  bus_->publish(channels::kPoses, first);
  // The program listens; one message of each kind, then the second genuine one ends it.
  bus_->publish(channels::kPoses, encode(answer_with("evil", 2, 0.1)));
  auto altered = encode(answer_with("evil", 3, 0.1));
  stranger.sign(channels::kPoses, altered);
  bus_->publish(channels::kPoses, altered);
  bus_->publish(channels::kPoses, genuine(4, 60'000'000));
  const auto last = genuine(5);
  bus_->publish(channels::kPoses, last);
  const Finished run = watch.wait();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::Not(HasSubstr("evil")));
  EXPECT_THAT(run.out,
              HasSubstr("2 answers, each verified with the key; refused: altered 1, old 1, replayed "));
  EXPECT_THAT(run.out, HasSubstr("unsigned 1"));
}

TEST_F(WatchProcess, GoAndNoGoAreShownWithTheReason) {
  Child watch(program({"watch"}));
  edgepose_lcm::drill_targets_t targets{};
  targets.camera = "camera";
  targets.targets.resize(2);
  targets.targets_count = 2;
  targets.targets[0].name = "left", targets.targets[0].go = true;
  targets.targets[1].name = "right\033[2J", targets.targets[1].reason = "2 sigma beyond the tolerance";
  ASSERT_TRUE(eventually([&] {
    bus_->publish(channels::kDrillTargets, encode(targets));
    return !watch.out().empty();
  }));
  watch.signal(SIGTERM);
  const Finished run = watch.wait();
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, HasSubstr("left GO; right [2J NO-GO (2 sigma beyond the tolerance)"));
  EXPECT_EQ(run.out.find('\033'), std::string::npos) << "nothing from the network moves the terminal";
}

TEST_F(WatchProcess, AKeyThatOthersCanReadIsRefused) {
  const std::string key = folder_.write("key", "edgepose-key-1 " + std::string(64, 'a') + "\n");
  std::filesystem::permissions(key, std::filesystem::perms::others_read, std::filesystem::perm_options::add);
  expect_refused(Child(program({"watch", "--key", key, "--seconds", "1"})).wait(), {key, "chmod 600"});
}

}  // namespace
}  // namespace edgepose::test
