#include "client/service/recorder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>

#include "common/error.h"
#include "messaging/lcm_log.h"

namespace edgepose {
namespace {

using namespace std::chrono_literals;

ReceivedMessage message_on(const std::string& channel, size_t size) {
  return {channel, std::make_unique<std::byte[]>(size), size};
}

class Recording : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::map<std::string, uint64_t> logged() const {
    std::map<std::string, uint64_t> channels;
    LcmLogReader reader(path_);
    for (LoggedMessage each; reader.next(each);) ++channels[each.channel];
    EXPECT_EQ(reader.skipped_bytes(), 0u);
    EXPECT_FALSE(reader.is_cut_off());
    return channels;
  }
  static SteadyTime soon() { return std::chrono::steady_clock::now() + 30s; }
  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("recording_" + std::to_string(getpid()));
};

TEST_F(Recording, MessagesFromManyThreads) {
  Recorder recorder(path_, LcmLogWriter::Existing::kRefuse, {});
  {
    std::vector<std::jthread> senders;
    for (int i = 0; i < 4; ++i)
      senders.emplace_back([&, i] {
        for (int k = 0; k < 250; ++k) recorder.take(message_on("CHANNEL_" + std::to_string(i), 100));
      });
  }
  recorder.finish();
  EXPECT_EQ(recorder.counters().messages, 1000u);
  EXPECT_EQ(recorder.counters().dropped, 0u);
  EXPECT_EQ(recorder.counters().bytes, std::filesystem::file_size(path_));
  EXPECT_EQ(logged(), recorder.counters().channels);
}

TEST_F(Recording, WhatTheQueueHasNoRoomForIsCounted) {
  Recorder::Options options;
  options.queue_bytes = 10'000;
  Recorder recorder(path_, LcmLogWriter::Existing::kRefuse, options);
  recorder.take(message_on("TOO_LARGE", 20'000));
  recorder.take(message_on("FITS", 5'000));
  recorder.finish();
  recorder.take(message_on("LATE", 10));
  EXPECT_EQ(recorder.counters().dropped, 2u);
  EXPECT_THAT(logged(), testing::ElementsAre(testing::Pair("FITS", 1)));
}

TEST_F(Recording, AsManyAsAreWantedOfTheChannelsThatAreWanted) {
  Recorder::Options options;
  options.max_messages = 3;
  options.channels = {"WANTED"};
  Recorder recorder(path_, LcmLogWriter::Existing::kRefuse, options);
  for (int i = 0; i < 10; ++i) recorder.take(message_on(i % 2 == 0 ? "WANTED" : "OTHER", 10));
  const SteadyTime end = soon();
  recorder.wait({}, end);
  EXPECT_LT(std::chrono::steady_clock::now(), end);
  recorder.finish();
  EXPECT_THAT(logged(), testing::ElementsAre(testing::Pair("WANTED", 3)));
}

TEST_F(Recording, AFullDiskEndsTheWaitAndIsTold) {
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{300'000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  Recorder recorder(path_, LcmLogWriter::Existing::kRefuse, {});
  for (int i = 0; i < 40; ++i) recorder.take(message_on("DATA", 100'000));
  const SteadyTime end = soon();
  recorder.wait({}, end);
  EXPECT_LT(std::chrono::steady_clock::now(), end);
  EXPECT_THROW(recorder.finish(), InputError);
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(recorder.counters().messages, 2u);
  EXPECT_THAT(logged(), testing::ElementsAre(testing::Pair("DATA", 2)));
}

}  // namespace
}  // namespace edgepose
