#include "messaging/lcm_log_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <lcm/lcm-cpp.hpp>

#include "common/error.h"
#include "messaging/lcm_log.h"

namespace edgepose {
namespace {

using Bytes = std::vector<std::byte>;
using Existing = LcmLogWriter::Existing;

/// Limits how large files may become, as long as it lives: what a full disk does, without one.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit small{bytes, limit_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &limit_);
    std::signal(SIGXFSZ, before_);
  }

 private:
  rlimit limit_{};
  void (*before_)(int);
};

class LcmLogWritten : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  std::vector<LoggedMessage> read() const {
    LcmLogReader reader(path_);
    std::vector<LoggedMessage> all;
    for (LoggedMessage message; reader.next(message);) all.push_back(message);
    EXPECT_EQ(reader.skipped_bytes(), 0u);
    EXPECT_FALSE(reader.is_cut_off());
    return all;
  }
  std::filesystem::path path_ =
      std::filesystem::path(testing::TempDir()) / ("lcm_log_writer_" + std::to_string(getpid()));
};

TEST_F(LcmLogWritten, OurReaderReadsItBack) {
  const std::vector<size_t> sizes = {0, 1, 100, 3'000'000, 7};
  {
    LcmLogWriter writer(path_);
    for (size_t i = 0; i < sizes.size(); ++i)
      writer.write(static_cast<int64_t>(1000 + i), "CHANNEL_" + std::to_string(i),
                   Bytes(sizes[i], static_cast<std::byte>(i)));
    writer.close();
    EXPECT_EQ(writer.records(), sizes.size());
    EXPECT_EQ(writer.bytes(), std::filesystem::file_size(path_));
  }
  const auto messages = read();
  ASSERT_EQ(messages.size(), sizes.size());
  for (size_t i = 0; i < sizes.size(); ++i) {
    EXPECT_EQ(messages[i].event, static_cast<int64_t>(i));
    EXPECT_EQ(messages[i].receive_utime, static_cast<int64_t>(1000 + i));
    EXPECT_EQ(messages[i].channel, "CHANNEL_" + std::to_string(i));
    EXPECT_EQ(messages[i].data, Bytes(sizes[i], static_cast<std::byte>(i)));
  }
}

TEST_F(LcmLogWritten, LiblcmReadsItBack) {
  {
    LcmLogWriter writer(path_);
    writer.write(1'700'000'000'000'001, "POSES", Bytes(40, std::byte{3}));
    writer.write(1'700'000'000'000'002, "EDGEPOSE_DEPTH", Bytes(70'000, std::byte{4}));
  }
  lcm::LogFile log(path_.string(), "r");
  ASSERT_TRUE(log.good());
  const lcm::LogEvent* event = log.readNextEvent();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->channel, "POSES");
  EXPECT_EQ(event->timestamp, 1'700'000'000'000'001);
  EXPECT_EQ(event->datalen, 40);
  event = log.readNextEvent();
  ASSERT_NE(event, nullptr);
  EXPECT_EQ(event->channel, "EDGEPOSE_DEPTH");
  ASSERT_EQ(event->datalen, 70'000);
  EXPECT_EQ(static_cast<const char*>(event->data)[69'999], 4);
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(LcmLogWritten, AnExistingFileIsReplacedOnlyOnDemand) {
  std::ofstream(path_) << "mine";
  EXPECT_THROW(LcmLogWriter{path_}, InputError);
  EXPECT_EQ(std::filesystem::file_size(path_), 4u);
  LcmLogWriter(path_, Existing::kReplace).write(1, "A", {});
  EXPECT_EQ(read().size(), 1u);
}

TEST_F(LcmLogWritten, NeitherFolderNorDeviceIsTaken) {
  EXPECT_THROW(LcmLogWriter(testing::TempDir(), Existing::kReplace), InputError);
  EXPECT_THROW(LcmLogWriter("/dev/full", Existing::kReplace), InputError);
  EXPECT_THROW(LcmLogWriter(testing::TempDir() + "no_such_folder/log"), InputError);
}

TEST_F(LcmLogWritten, AFullDiskKeepsWholeRecordsAndSaysHowMany) {
  // Records of 128 bytes; the disk ends in the middle of one.
  for (const rlim_t room : {100, 128, 1000, 2'500'001}) {
    LcmLogWriter writer(path_, Existing::kReplace);
    const FileSizeLimit full(room);
    std::string fault;
    try {
      for (int i = 0; i < 50'000; ++i) writer.write(i, "ABCD", Bytes(96));
      writer.flush();
    } catch (const InputError& error) {
      fault = error.what();
    }
    const size_t whole = static_cast<size_t>(room) / 128;
    EXPECT_THAT(fault, testing::HasSubstr(std::to_string(whole) + " messages"));
    EXPECT_THAT(fault, testing::HasSubstr(path_.string()));
    EXPECT_EQ(std::filesystem::file_size(path_), 128 * whole);
    EXPECT_EQ(writer.records(), whole);
    if (whole > 0) {
      EXPECT_EQ(read().size(), whole);
    }
  }
}

TEST_F(LcmLogWritten, ChannelsThatNoReaderTakesAreRefused) {
  LcmLogWriter writer(path_);
  EXPECT_THROW(writer.write(0, "", {}), std::invalid_argument);
  EXPECT_THROW(writer.write(0, std::string(256, 'c'), {}), std::invalid_argument);
}

}  // namespace
}  // namespace edgepose
