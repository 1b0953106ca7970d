#include "messaging/lcm_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/error.h"
#include "messaging/big_endian.h"

namespace edgepose {
namespace {

using Bytes = std::vector<std::byte>;

Bytes record(int64_t event, const std::string& channel, size_t size) {
  Bytes bytes(28);
  write_big_endian<uint32_t>(0xeda1da01, bytes, 0);
  write_big_endian<int64_t>(event, bytes, 4);
  write_big_endian<int64_t>(1000 * event, bytes, 12);
  write_big_endian<int32_t>(static_cast<int32_t>(channel.size()), bytes, 20);
  write_big_endian<int32_t>(static_cast<int32_t>(size), bytes, 24);
  for (const char c : channel) bytes.push_back(static_cast<std::byte>(c));
  bytes.resize(bytes.size() + size, std::byte{0x2a});
  return bytes;
}

class LcmLog : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  void write(const Bytes& bytes) const {
    std::ofstream(path_, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  }
  /// Numbers of the events that are read.
  std::vector<int64_t> events(LcmLogReader& reader) const {
    std::vector<int64_t> all;
    for (LoggedMessage message; reader.next(message);) all.push_back(message.event);
    return all;
  }
  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("lcm_log_" + std::to_string(getpid()));
};

TEST_F(LcmLog, EveryRecordInOrder) {
  Bytes log = record(1, "POSES", 5);
  for (const Bytes& more : {record(2, "DEPTH", 100000), record(3, "POSES", 0)})
    log.insert(log.end(), more.begin(), more.end());
  write(log);
  LcmLogReader reader(path_);
  LoggedMessage message;
  ASSERT_TRUE(reader.next(message));
  EXPECT_EQ(message.channel, "POSES");
  EXPECT_EQ(message.receive_utime, 1000);
  EXPECT_EQ(message.data, Bytes(5, std::byte{0x2a}));
  EXPECT_THAT(events(reader), testing::ElementsAre(2, 3));
  EXPECT_EQ(reader.skipped_bytes(), 0u);
  EXPECT_FALSE(reader.is_cut_off());
}

TEST_F(LcmLog, CutOffAnywhereItIsReadAsFarAsItGoes) {
  const Bytes first = record(1, "A", 40), second = record(2, "B", 40);
  Bytes log = first;
  log.insert(log.end(), second.begin(), second.end());
  for (size_t size = first.size(); size < log.size(); ++size) {
    write(Bytes(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(size)));
    LcmLogReader reader(path_);
    EXPECT_THAT(events(reader), testing::ElementsAre(1)) << size;
    EXPECT_EQ(reader.is_cut_off(), size > first.size()) << size;
  }
}

TEST_F(LcmLog, WrongLengthsCostOneRecord) {
  // liblcm's reader stops at the first of these.
  for (const int32_t lie : {-1, 0x7fffffff, 100000}) {
    Bytes log = record(1, "A", 40);
    Bytes bad = record(2, "B", 40);
    write_big_endian<int32_t>(lie, bad, 24);
    const Bytes last = record(3, "C", 40);
    log.insert(log.end(), bad.begin(), bad.end());
    log.insert(log.end(), last.begin(), last.end());
    write(log);
    LcmLogReader reader(path_);
    EXPECT_THAT(events(reader), testing::ElementsAre(1, 3)) << lie;
    EXPECT_EQ(reader.skipped_bytes(), bad.size()) << lie;
    EXPECT_FALSE(reader.is_cut_off());
  }
}

TEST_F(LcmLog, GarbageBetweenRecordsIsSkipped) {
  Bytes log(70000, std::byte{0xed});
  const Bytes first = record(1, "A", 4), second = record(2, "B", 4);
  log.insert(log.end(), first.begin(), first.end());
  log.resize(log.size() + 100000);
  log.insert(log.end(), second.begin(), second.end());
  write(log);
  LcmLogReader reader(path_);
  EXPECT_THAT(events(reader), testing::ElementsAre(1, 2));
  EXPECT_EQ(reader.skipped_bytes(), 170000u);
}

TEST_F(LcmLog, WhatIsNoLogIsRefused) {
  EXPECT_THROW(LcmLogReader{path_}, InputError);
  write(Bytes(5000));
  EXPECT_THROW(LcmLogReader{path_}, InputError);
  write({});
  EXPECT_THROW(LcmLogReader{path_}, InputError);
  EXPECT_THROW(LcmLogReader{testing::TempDir()}, InputError);
}

}  // namespace
}  // namespace edgepose
