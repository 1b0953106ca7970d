/// `edgepose record` over real LCM.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <random>

#include "messaging/lcm_log.h"
#include "messaging/lcm_log_writer.h"
#include "tests/client/child.h"
#include "tests/client/fake_service.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::byte>;

class RecordProcess : public OnOwnNetwork {
 protected:
  static std::vector<LoggedMessage> read(const std::string& path) {
    LcmLogReader reader(path);
    std::vector<LoggedMessage> all;
    for (LoggedMessage message; reader.next(message);) all.push_back(message);
    EXPECT_FALSE(reader.is_cut_off());
    EXPECT_EQ(reader.skipped_bytes(), 0u);
    return all;
  }
  /// Its receiver is there.
  static bool is_recording(const Child& record) {
    return eventually([&] { return record.err().find("recording to") != std::string::npos; });
  }
  Folder folder_;
  const std::string log_ = folder_ / "log";
};

Bytes random_bytes(std::mt19937_64& random, size_t size) {
  Bytes bytes(size);
  for (auto& b : bytes) b = static_cast<std::byte>(random() & 0xff);
  return bytes;
}

TEST_F(RecordProcess, WhatLcmLogplayerPlaysComesBackBitForBit) {
  const std::string played = folder_ / "played";
  std::mt19937_64 random(1);
  std::vector<Bytes> sent;
  {
    LcmLogWriter writer(played);
    for (int i = 0; i < 40; ++i) {
      sent.push_back(random_bytes(random, random() % 200'000));
      writer.write(1000 * i, i % 2 == 0 ? "EVEN" : "ODD", sent.back());
    }
    writer.close();
  }
  Child record(program({"record", log_, "--messages", "40", "--channel", "EVEN", "--channel", "ODD"}));
  ASSERT_TRUE(is_recording(record)) << record.err();
  Child player({"lcm-logplayer", "-l", kDefaultLcmUrl, played});
  const Finished run = record.wait();
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("recorded 40 messages"));
  EXPECT_THAT(run.out, HasSubstr("lost: nothing"));
  const auto messages = read(log_);
  ASSERT_EQ(messages.size(), 40u);
  for (size_t i = 0; i < 40; ++i) {
    EXPECT_EQ(messages[i].channel, i % 2 == 0 ? "EVEN" : "ODD");
    EXPECT_EQ(messages[i].data, sent[i]) << i;
    EXPECT_NEAR(static_cast<double>(messages[i].receive_utime), static_cast<double>(utime_now()), 60e6);
  }
}

TEST_F(RecordProcess, CtrlCEndsItAndOnlyChosenChannelsAreKept) {
  Bus bus;
  Child record(program({"record", log_, "--channel", "WANTED"}));
  ASSERT_TRUE(is_recording(record)) << record.err();
  bus.publish("OTHER", Bytes(10));
  bus.publish("WANTED", Bytes(20));
  ASSERT_TRUE(eventually([&] { return std::filesystem::file_size(log_) > 0; })) << "written as it comes";
  record.signal(SIGINT);
  const Finished run = record.wait();
  EXPECT_EQ(run.code, 0) << run.err;
  const auto messages = read(log_);
  ASSERT_EQ(messages.size(), 1u);
  EXPECT_EQ(messages[0].channel, "WANTED");
}

TEST_F(RecordProcess, AnExistingFileIsReplacedOnlyWithForce) {
  folder_.write("log", "mine");
  const Finished refused = Child(program({"record", log_})).wait();
  expect_refused(refused, {log_, "--force"});
  EXPECT_EQ(read_file(log_), "mine");
  Bus bus;
  Child record(program({"record", log_, "--force", "--messages", "1"}));
  ASSERT_TRUE(is_recording(record)) << record.err();
  bus.publish("A", Bytes(20));
  EXPECT_EQ(record.wait().code, 0);
  EXPECT_EQ(read(log_).size(), 1u);
}

TEST_F(RecordProcess, AFullDiskKeepsASoundLog) {
  Bus bus;
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit small{200'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);  // inherited by the program
  Child record(program({"record", log_}));
  setrlimit(RLIMIT_FSIZE, &before);
  ASSERT_TRUE(is_recording(record)) << record.err();
  for (int i = 0; i < 30; ++i) bus.publish("DATA", Bytes(10'000));
  const Finished run = record.wait();
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr(log_ + ": expected room for the log, found File too large; 19 messages"));
  EXPECT_EQ(read(log_).size(), 19u);
}

TEST_F(RecordProcess, ATimeEndsItToo) {
  const Finished run = Child(program({"record", log_, "--seconds", "0.1"})).wait();
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, HasSubstr("recorded 0 messages"));
}

}  // namespace
}  // namespace edgepose::test
