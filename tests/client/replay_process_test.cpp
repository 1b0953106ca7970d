/// `edgepose replay` and `compare` over real LCM.
#include <gmock/gmock.h>

#include <fstream>

#include "messaging/lcm_log.h"
#include "messaging/lcm_log_writer.h"
#include "tests/client/child.h"
#include "tests/client/fake_service.h"
#include "tests/shared_data.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

const std::string kSet = std::string(EDGEPOSE_SOURCE_DIR) + "/models/sample_set/test/000001";

class ReplayProcess : public OnOwnNetwork {
 protected:
  /// A session: the sample's six frames and their answers.
  std::string session(FakeService&) const {
    const std::string log = folder_ / "session";
    Child record(program({"record", log, "--messages", "12"}));
    EXPECT_TRUE(eventually([&] { return record.err().find("recording to") != std::string::npos; }));
    EXPECT_EQ(Child(program({"send", kSet, "--wait", "--rate", "0"})).wait().code, 0);
    EXPECT_EQ(record.wait().code, 0);
    return log;
  }
  Finished replay(const std::string& log, const std::string& out, std::vector<std::string> more = {}) const {
    more.insert(more.begin(), {"replay", log, "--speed", "0", "--record", out});
    return Child(program(more)).wait();
  }
  Folder folder_;
};

TEST_F(ReplayProcess, AnswersToTheSameFramesAreEqualBitForBit) {
  FakeService service;
  const std::string log = session(service), again = folder_ / "again";
  const int64_t before = utime_now();
  const Finished run = replay(log, again);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("answered 6"));
  const Finished same = Child(program({"compare", log, again})).wait();
  EXPECT_EQ(same.code, 0) << same.out << same.err;
  EXPECT_THAT(same.out, HasSubstr("equal bit for bit"));
  // As if taken now, and beyond what was sent before.
  edgepose_lcm::depth_frame_t first, last;
  ASSERT_EQ(decode_checked(std::span<const std::byte>(service.bus().on(channels::kDepth)[5]), first), "");
  ASSERT_EQ(decode_checked(std::span<const std::byte>(service.bus().on(channels::kDepth)[6]), last), "");
  EXPECT_GT(last.sequence, first.sequence);
  EXPECT_GE(last.capture_utime, before);
}

TEST_F(ReplayProcess, OtherAnswersAreDifferentUnlessTolerated) {
  FakeService service;
  const std::string log = session(service), again = folder_ / "again";
  service.offset = 0.001;
  ASSERT_EQ(replay(log, again).code, 0);
  const Finished other = Child(program({"compare", log, again})).wait();
  EXPECT_EQ(other.code, 1) << other.out;
  EXPECT_THAT(other.out, HasSubstr("different"));
  EXPECT_EQ(Child(program({"compare", log, again, "--tolerance-mm", "1.1"})).wait().code, 0);
  EXPECT_EQ(Child(program({"compare", log, again, "--tolerance-mm", "0.9"})).wait().code, 1);
}

TEST_F(ReplayProcess, AnswersThatDoNotComeAreMissing) {
  FakeService service;
  const std::string log = session(service);
  service.silent = true;
  const Finished run = Child(program({"replay", log, "--speed", "0", "--timeout", "0.05"})).wait();
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, HasSubstr("answered 0"));
}

TEST_F(ReplayProcess, KeptTimesAreThoseOfTheLog) {
  FakeService service;
  const std::string log = session(service);
  const size_t before = service.bus().count(channels::kDepth);
  ASSERT_EQ(Child(program({"replay", log, "--speed", "0", "--keep-times"})).wait().code, 0);
  const auto heard = service.bus().on(channels::kDepth);
  ASSERT_EQ(heard.size(), 2 * before);
  for (size_t i = 0; i < before; ++i) EXPECT_EQ(heard[i], heard[i + before]);
}

TEST_F(ReplayProcess, TheFirstAnswersOfTheServiceMayBeLeftOutOfTheLog) {
  FakeService service;
  const std::string log = session(service);
  const std::string bytes = read_file(log);
  folder_.write("cut", bytes.substr(0, bytes.size() - 10));
  const Finished run = Child(program({"replay", folder_ / "cut", "--speed", "0"})).wait();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("cut off"));
}

class ForeignLog : public ReplayProcess, public testing::WithParamInterface<std::string> {};

TEST_P(ForeignLog, IsSentAsItIsOrRefusedWithItsChannels) {
  EDGEPOSE_NEEDS_SHARED("lcm_logs");
  const std::string log = shared_data("lcm_logs/" + GetParam());
  Bus bus;
  LcmLogReader reader(log);
  std::map<std::string, std::vector<std::vector<std::byte>>> logged;
  for (LoggedMessage message; reader.next(message);) logged[message.channel].push_back(message.data);
  const Finished all = Child(program({"replay", log, "--all", "--speed", "1000"})).wait();
  ASSERT_EQ(all.code, 0) << all.err;
  for (const auto& [channel, messages] : logged) {
    ASSERT_TRUE(bus.wait_for(channel, messages.size())) << channel;
    EXPECT_EQ(bus.on(channel), messages) << channel;
  }
  const Finished refused = Child(program({"replay", log})).wait();
  expect_refused(refused, {"EDGEPOSE_DEPTH", "--all", logged.begin()->first});
}

INSTANTIATE_TEST_SUITE_P(All, ForeignLog,
                         testing::Values("image_metadata_log.lcm", "pr2_visualization.lcmlog", "testlog.lcm"),
                         [](const auto& log) { return log.param.substr(0, log.param.find('.')); });

TEST_F(ReplayProcess, BadInputIsOneLine) {
  const std::string text = folder_.write("text", "no log at all");
  expect_refused(Child(program({"replay", text})).wait(), {text, "LCM log"});
  expect_refused(Child(program({"replay", folder_ / "none"})).wait(), {"none"});
  expect_refused(Child(program({"compare", text})).wait(), {"two logs"});
  expect_refused(Child(program({"compare", text, text})).wait(), {text});
  {
    LcmLogWriter writer(folder_ / "foreign");
    writer.write(1, "OTHER", std::vector<std::byte>(4));
  }
  expect_refused(Child(program({"compare", folder_ / "foreign", folder_ / "foreign"})).wait(),
                 {"EDGEPOSE_POSES"});
  expect_refused(
      Child(program({"replay", folder_ / "foreign", "--record", folder_ / "foreign", "--force", "--all"}))
          .wait(),
      {"foreign"});
}

}  // namespace
}  // namespace edgepose::test
