#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>
#include <random>

#include "bus/frame_record.h"
#include "bus/pcap_reader.h"
#include "bus/pcap_replay_bus.h"
#include "bus/pcap_writer.h"
#include "bus/steady_clock.h"
#include "common/error.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

using Kind = Received::Kind;

constexpr int64_t kWall = 1'700'000'000'000'000'000;  ///< [ns] since 1970

CanFrame numbered(int i) {
  CanFrame frame{.id = static_cast<uint16_t>(0x180 + i % 0x600),
                 .size = static_cast<uint8_t>(i % 9),
                 .data = {},
                 .time_ns = int64_t{i} * 1'000'000};
  for (uint8_t k = 0; k < frame.size; ++k) frame.data[k] = static_cast<uint8_t>(i + k);
  return frame;
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void put(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

void record(const std::filesystem::path& path, int count) {
  PcapWriter writer(path, kWall);
  for (int i = 0; i < count; ++i) writer.write(numbered(i));
}

/// Reads to the end; the number of frames.
int frames_in(const std::filesystem::path& path) {
  PcapReader reader(path);
  int count = 0;
  while (reader.next().kind != Kind::kNothing) ++count;
  return count;
}

TEST(FrameRecord, IsSocketCansLayout) {
  const FrameRecord record = to_record({.id = 0x601, .size = 3, .data = {1, 2, 3}, .time_ns = 5});
  EXPECT_EQ(record, (FrameRecord{0, 0, 0x06, 0x01, 3, 0, 0, 0, 1, 2, 3, 0, 0, 0, 0, 0}));
}

TEST(FrameRecord, RoundTripAndArbitraryBytes) {
  std::mt19937 random(1);
  for (int i = 0; i < 5000; ++i) {
    const Received back = from_record(to_record(numbered(i)));
    ASSERT_EQ(back.kind, Kind::kFrame);
    EXPECT_TRUE(back.frame.says_the_same(numbered(i)));
  }
  int frames = 0;
  for (int i = 0; i < 200000; ++i) {
    std::vector<uint8_t> bytes(random() % 20);
    for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random());
    if (bytes.size() > 4 && random() % 2) bytes[0] = bytes[1] = 0, bytes[2] &= 7, bytes[4] &= 7;
    const Received read = from_record(bytes);
    frames += read.kind == Kind::kFrame;
    if (read.kind == Kind::kFrame) {
      EXPECT_LE(read.frame.id, CanFrame::kMaxId);
      EXPECT_LE(read.frame.size + 8u, bytes.size());
    }
  }
  EXPECT_GT(frames, 1000);
}

TEST(FrameRecord, ErrorFramesAreEvents) {
  const auto event = [](uint32_t error_class, uint8_t second = 0) {
    FrameRecord record{0x20, 0, static_cast<uint8_t>(error_class >> 8), static_cast<uint8_t>(error_class), 8};
    record[9] = second;
    return from_record(record).event;
  };
  EXPECT_EQ(event(0x40), BusEvent::kBusOff);
  EXPECT_EQ(event(0x04, 0x20), BusEvent::kErrorPassive);
  EXPECT_EQ(event(0x04, 0x08), BusEvent::kErrorWarning);
  EXPECT_EQ(event(0x04, 0x01), BusEvent::kControllerOverrun);
  EXPECT_EQ(event(0x100), BusEvent::kRestarted);
  EXPECT_EQ(event(0x20), BusEvent::kNoAcknowledge);
  EXPECT_EQ(event(0x44, 0x20), BusEvent::kBusOff) << "the gravest";
  EXPECT_STREQ(name_of(BusEvent::kBusOff), "bus-off");
}

TEST(Pcap, WhatIsWrittenIsRead) {
  const TemporaryFolder folder;
  record(folder / "f.pcap", 3000);
  PcapReader reader(folder / "f.pcap");
  for (int i = 0; i < 3000; ++i) {
    const Received read = reader.next();
    ASSERT_EQ(read.kind, Kind::kFrame);
    ASSERT_TRUE(read.frame.says_the_same(numbered(i)));
    ASSERT_EQ(read.frame.time_ns, kWall + numbered(i).time_ns);
  }
  EXPECT_EQ(reader.next().kind, Kind::kNothing);
  EXPECT_FALSE(reader.is_cut_off());
  EXPECT_EQ(content(folder / "f.pcap").size(), 24u + 3000 * 32);
}

TEST(Pcap, CutOffAnywhereItIsReadAsFarAsItGoes) {
  const TemporaryFolder folder;
  record(folder / "f.pcap", 3);
  const std::string whole = content(folder / "f.pcap");
  for (size_t size = 24; size < whole.size(); ++size) {
    put(folder / "g.pcap", whole.substr(0, size));
    EXPECT_EQ(frames_in(folder / "g.pcap"), static_cast<int>((size - 24) / 32)) << size;
  }
  for (size_t size = 0; size < 24; ++size) {
    put(folder / "g.pcap", whole.substr(0, size));
    EXPECT_THROW(PcapReader(folder / "g.pcap"), InputError) << size;
  }
}

TEST(Pcap, OtherByteOrderAndNanoseconds) {
  const TemporaryFolder folder;
  const auto big = [](uint32_t value) {
    return std::string{static_cast<char>(value >> 24), static_cast<char>(value >> 16),
                       static_cast<char>(value >> 8), static_cast<char>(value)};
  };
  const FrameRecord frame = to_record({.id = 0x77f, .size = 1, .data = {5}, .time_ns = 0});
  const std::string bytes = big(0xa1b23c4d) + big(0x0002'0004) + big(0) + big(0) + big(16) + big(227) +
                            big(7) + big(123456789) + big(16) + big(16) +
                            std::string(frame.begin(), frame.end());
  put(folder / "f.pcap", bytes);
  PcapReader reader(folder / "f.pcap");
  const Received read = reader.next();
  ASSERT_EQ(read.kind, Kind::kFrame);
  EXPECT_EQ(read.frame.id, 0x77f);
  EXPECT_EQ(read.frame.time_ns, 7'123'456'789);
}

TEST(Pcap, LengthsThatCannotBeEndIt) {
  const TemporaryFolder folder;
  record(folder / "f.pcap", 3);
  for (const uint32_t lie : {4097u, 0x7fffffffu, 0xffffffffu}) {
    std::string bytes = content(folder / "f.pcap");
    bytes.replace(24 + 32 + 8, 4, reinterpret_cast<const char*>(&lie), 4);
    put(folder / "g.pcap", bytes);
    PcapReader reader(folder / "g.pcap");
    EXPECT_EQ(reader.next().kind, Kind::kFrame);
    EXPECT_EQ(reader.next().kind, Kind::kNothing);
    EXPECT_TRUE(reader.is_cut_off());
  }
}

TEST(Pcap, WhatIsNoCaptureOfCan) {
  const TemporaryFolder folder;
  EXPECT_THROW(PcapReader(folder / "none"), InputError);
  put(folder / "text", "this is a text that is long enough");
  EXPECT_THROW(PcapReader(folder / "text"), InputError);
  record(folder / "f.pcap", 1);
  std::string ethernet = content(folder / "f.pcap");
  ethernet[20] = 1;
  put(folder / "ethernet", ethernet);
  try {
    PcapReader reader(folder / "ethernet");
    FAIL() << "taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::HasSubstr("expected a capture of SocketCAN (link type 227), found link type 1"));
  }
}

/// While it lives, files of this process end at `bytes`, as on a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) {
    old_handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit small{.rlim_cur = bytes, .rlim_max = old_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
  }
  ~FullDisk() {
    setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, old_handler_);
  }

 private:
  rlimit old_{};
  void (*old_handler_)(int) = nullptr;
};

TEST(Pcap, FullDiskIsCountedAndTheFileEndsWithAWholeRecord) {
  const TemporaryFolder folder;
  PcapWriter writer(folder / "f.pcap", kWall);
  {
    const FullDisk full(24 + 10 * 32 + 17);  // in the middle of the eleventh record
    for (int i = 0; i < 25; ++i) writer.write(numbered(i));
    writer.flush();
    EXPECT_EQ(writer.written(), 10u);
    EXPECT_EQ(writer.lost(), 15u);
    EXPECT_EQ(writer.last_error(), EFBIG);
    EXPECT_EQ(content(folder / "f.pcap").size(), 24u + 10 * 32);
  }
  for (int i = 0; i < 5; ++i) writer.write(numbered(i));
  writer.flush();
  EXPECT_EQ(writer.written(), 15u) << "there is room again";
  EXPECT_EQ(frames_in(folder / "f.pcap"), 15);
}

TEST(Pcap, CannotBeWritten) {
  EXPECT_THROW(PcapWriter("/nowhere/f.pcap", 0), InputError);
  EXPECT_THROW(PcapWriter("/dev/full", 0), InputError);
}

TEST(PcapReplayBus, AtOnce) {
  const TemporaryFolder folder;
  record(folder / "f.pcap", 100);
  PcapReplayBus bus(folder / "f.pcap", PcapReplayBus::Pace::kAtOnce);
  for (int i = 0; i < 100; ++i) {
    const Received received = bus.receive(0);
    ASSERT_EQ(received.kind, Kind::kFrame);
    EXPECT_TRUE(received.frame.says_the_same(numbered(i)));
  }
  EXPECT_EQ(bus.receive(0).event, BusEvent::kEnd);
  EXPECT_EQ(bus.receive(0).kind, Kind::kNothing);
  EXPECT_EQ(bus.send(numbered(0)), SendResult::kSent);
  EXPECT_EQ(bus.counters().received, 100u);
}

TEST(PcapReplayBus, AtTheRecordedPace) {
  const TemporaryFolder folder;
  record(folder / "f.pcap", 31);  // a frame each ms
  PcapReplayBus bus(folder / "f.pcap");
  const int64_t from = steady_ns();
  int count = 0, nothing = 0;
  for (;;) {
    const Received received = bus.receive(steady_ns() + 300'000);
    if (received.kind == Kind::kEvent) break;
    ++(received.kind == Kind::kFrame ? count : nothing);
    if (received.kind == Kind::kFrame) {
      EXPECT_GE(steady_ns(), received.frame.time_ns);
    }
  }
  EXPECT_EQ(count, 31);
  EXPECT_GT(nothing, 0) << "deadlines before the next frame";
  EXPECT_GE(steady_ns() - from, 30'000'000);
}

}  // namespace
}  // namespace edgepose
