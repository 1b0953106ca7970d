#include "bus/unix_bus.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "bus/open_bus.h"
#include "bus/pcap_reader.h"
#include "bus/steady_clock.h"
#include "bus/tapped_bus.h"
#include "bus/unix_address.h"
#include "bus/unix_bus_hub.h"
#include "common/error.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

using Kind = Received::Kind;

constexpr int64_t kSecond = 1'000'000'000;

CanFrame with_number(int i) {
  CanFrame frame{.id = 0x123, .size = 8, .data = {}, .time_ns = 0};
  for (size_t k = 0; k < 4; ++k) frame.data[k] = static_cast<uint8_t>(i >> 8 * k);
  return frame;
}

int number_of(const CanFrame& frame) {
  int number = 0;
  for (size_t k = 0; k < 4; ++k) number |= frame.data[k] << 8 * k;
  return number;
}

/// A hub that serves on a thread of its own.
class RunningHub {
 public:
  explicit RunningHub(const std::filesystem::path& path, const UnixBusHubOptions& options = {})
      : hub_(std::make_unique<UnixBusHub>(path, options)), thread_([this] {
          while (!stop_) {
            hub_->serve(steady_ns() + 5'000'000);
            members_ = hub_->members();
          }
        }) {}
  ~RunningHub() { end(); }
  void end() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    counters_ = hub_ ? hub_->counters() : counters_;
    hub_.reset();
  }
  /// Waits until this many have joined.
  bool has(size_t members) const {
    for (const int64_t until = steady_ns() + 5 * kSecond; steady_ns() < until;) {
      if (members_ == members) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  }
  UnixBusHubCounters counters() {
    end();
    return counters_;
  }

 private:
  std::unique_ptr<UnixBusHub> hub_;
  UnixBusHubCounters counters_;
  std::atomic<bool> stop_ = false;
  std::atomic<size_t> members_ = 0;
  std::thread thread_;
};

TEST(UnixBus, EachFrameGoesToAllOthersInOrder) {
  const TemporaryFolder folder;
  RunningHub hub(folder / "bus");
  UnixBus a(folder / "bus"), b(folder / "bus"), c(folder / "bus");
  ASSERT_TRUE(hub.has(3));
  for (int i = 0; i < 200; ++i) ASSERT_EQ(a.send(with_number(i)), SendResult::kSent);
  for (UnixBus* other : {&b, &c})
    for (int i = 0; i < 200; ++i) {
      const Received received = other->receive(steady_ns() + 5 * kSecond);
      ASSERT_EQ(received.kind, Kind::kFrame);
      EXPECT_EQ(number_of(received.frame), i);
      EXPECT_NEAR(static_cast<double>(received.frame.time_ns), static_cast<double>(steady_ns()), 5e9);
    }
  EXPECT_EQ(a.receive(steady_ns() + 20'000'000).kind, Kind::kNothing) << "not to the sender";
  EXPECT_EQ(b.counters().received, 200u);
}

TEST(UnixBus, ReceiveWaitsUntilItsDeadline) {
  const TemporaryFolder folder;
  RunningHub hub(folder / "bus");
  UnixBus bus(folder / "bus");
  const int64_t from = steady_ns();
  EXPECT_EQ(bus.receive(from + 30'000'000).kind, Kind::kNothing);
  EXPECT_GE(steady_ns() - from, 30'000'000);
}

TEST(UnixBus, AfterTheHubHasGoneItIsDown) {
  const TemporaryFolder folder;
  auto hub = std::make_unique<RunningHub>(folder / "bus");
  UnixBus bus(folder / "bus");
  ASSERT_TRUE(hub->has(1));
  hub.reset();
  EXPECT_EQ(bus.receive(steady_ns() + kSecond).event, BusEvent::kDown);
  EXPECT_EQ(bus.receive(0).kind, Kind::kNothing);
  EXPECT_EQ(bus.send(with_number(1)), SendResult::kDown);
  EXPECT_EQ(bus.counters().not_sent, 1u);
  EXPECT_FALSE(std::filesystem::exists(folder / "bus"));
}

TEST(UnixBusHub, AMemberThatDoesNotTakeItsFramesIsCutOffAndTheOthersAreServed) {
  const TemporaryFolder folder;
  RunningHub hub(folder / "bus", {.max_members = 16, .max_waiting = 64});
  UnixBus fast(folder / "bus"), slow(folder / "bus"), other(folder / "bus");
  ASSERT_TRUE(hub.has(3));
  constexpr int kFrames = 20000;
  int got = 0;
  for (int i = 0; i < kFrames; ++i) {
    while (fast.send(with_number(i)) == SendResult::kNoRoom) std::this_thread::yield();
    while (other.receive(i + 1 - got > 20 ? steady_ns() + kSecond : 0).kind == Kind::kFrame) ++got;
  }
  while (got < kFrames && other.receive(steady_ns() + kSecond).kind == Kind::kFrame) ++got;
  EXPECT_EQ(got, kFrames);
  EXPECT_TRUE(hub.has(2));
  Received last;
  do last = slow.receive(steady_ns() + kSecond);
  while (last.kind == Kind::kFrame);
  EXPECT_EQ(last.event, BusEvent::kDown);
  EXPECT_EQ(hub.counters().slow_cut_off, 1u);
}

TEST(UnixBusHub, WhoSendsWhatIsNoFrameIsCutOff) {
  const TemporaryFolder folder;
  RunningHub hub(folder / "bus");
  const int stranger = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  const UnixAddress address = unix_address(folder / "bus");
  ASSERT_EQ(connect(stranger, address.get(), sizeof(address.value)), 0);
  ASSERT_TRUE(hub.has(1));
  ASSERT_EQ(send(stranger, "hello", 5, 0), 5);
  EXPECT_TRUE(hub.has(0));
  close(stranger);
  EXPECT_EQ(hub.counters().wrong_cut_off, 1u);
}

TEST(UnixBusHub, TurnsAwayWhoIsTooMany) {
  const TemporaryFolder folder;
  RunningHub hub(folder / "bus", {.max_members = 2, .max_waiting = 64});
  UnixBus a(folder / "bus"), b(folder / "bus");
  ASSERT_TRUE(hub.has(2));
  UnixBus c(folder / "bus");
  EXPECT_EQ(c.receive(steady_ns() + 5 * kSecond).event, BusEvent::kDown);
  EXPECT_EQ(hub.counters().turned_away, 1u);
}

TEST(UnixBusHub, OneBusAPlaceAndADeadOnesSocketIsReplaced) {
  const TemporaryFolder folder;
  {
    UnixBusHub hub(folder / "bus");
    EXPECT_THROW(UnixBusHub(folder / "bus"), InputError);
  }
  const int left_behind = socket(AF_UNIX, SOCK_SEQPACKET, 0);
  const UnixAddress address = unix_address(folder / "bus");
  ASSERT_EQ(bind(left_behind, address.get(), sizeof(address.value)), 0);
  close(left_behind);
  EXPECT_NO_THROW(UnixBusHub(folder / "bus"));
}

/// The message, which must be one line.
std::string refusal(const std::string& name) {
  try {
    open_bus(name);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    return error.what();
  }
  return "none";
}

TEST(OpenBus, BusesThatDoNotExistAreNamed) {
  EXPECT_THAT(refusal("nocan7"), testing::StartsWith("bus nocan7: expected a CAN"));
  EXPECT_THAT(refusal("unix:/tmp/no/such/bus"),
              testing::StartsWith("bus unix:/tmp/no/such/bus: expected a bus that "
                                  "can be joined, found No such file"));
  EXPECT_THAT(refusal("pcap:/tmp/no/such.pcap"), testing::HasSubstr("/tmp/no/such.pcap: expected a capture"));
  EXPECT_THAT(refusal("tcp:1234"),
              testing::StartsWith("bus: expected can0, unix:/path or pcap:/file, found tcp:1234"));
  EXPECT_THAT(refusal(""), testing::StartsWith("bus : expected"));
  EXPECT_THAT(refusal("unix:" + std::string(200, 'a')), testing::HasSubstr("1 to 107 bytes, found 200"));
}

TEST(OpenBus, AnInterfaceThatIsNoCan) {
  EXPECT_THAT(refusal("lo"), testing::StartsWith("bus lo: expected a CAN"));
}

TEST(TappedBus, RecordsWhatIsSentAndReceived) {
  const TemporaryFolder folder;
  {
    RunningHub hub(folder / "bus");
    UnixBus other(folder / "bus");
    TappedBus tapped(open_bus("unix:" + (folder / "bus").string()),
                     std::make_unique<PcapWriter>(folder / "f.pcap", wall_minus_steady_ns()));
    ASSERT_TRUE(hub.has(2));
    CanFrame mine = with_number(1);
    mine.time_ns = steady_ns();
    EXPECT_EQ(tapped.send(mine), SendResult::kSent);
    other.send(with_number(2));
    ASSERT_EQ(tapped.receive(steady_ns() + 5 * kSecond).kind, Kind::kFrame);
    EXPECT_EQ(tapped.counters().received, 1u);
  }
  PcapReader reader(folder / "f.pcap");
  EXPECT_EQ(number_of(reader.next().frame), 1);
  EXPECT_EQ(number_of(reader.next().frame), 2);
  EXPECT_EQ(reader.next().kind, Kind::kNothing);
}

TEST(Arbitration, TheMostUrgentGoesFirstAndTheRestWaits) {
  Arbitration<int> wire(1000, 2, 3);
  EXPECT_TRUE(wire.put(0x300, 3, {}));
  EXPECT_TRUE(wire.put(0x200, 2, {}));
  EXPECT_TRUE(wire.put(0x100, 1, {}));
  EXPECT_EQ(wire.take(0)->from, 1);
  EXPECT_EQ(wire.take(0)->from, 2);
  EXPECT_FALSE(wire.take(0)) << "no time on the wire";
  EXPECT_EQ(wire.take(1'000'000)->from, 3);
}

TEST(Arbitration, ASendersFramesKeepTheirOrder) {
  Arbitration<int> wire(1000, 8, 3);
  for (const uint32_t id : {0x201u, 0x202u, 0x080u}) EXPECT_TRUE(wire.put(id, 1, {}));
  EXPECT_FALSE(wire.put(0x001, 1, {})) << "it has no more room";
  for (const uint32_t id : {0x201u, 0x202u, 0x080u}) EXPECT_EQ(wire.take(0)->id, id);
  EXPECT_TRUE(wire.empty());
}

TEST(UnixBusHub, AFloodOfUrgentFramesStarvesTheOthers) {
  const TemporaryFolder folder;
  UnixBusHubOptions options;
  options.rate = 8000;
  UnixBusHub hub(folder / "bus", options);
  UnixBus babbler(folder / "bus"), sender(folder / "bus"), receiver(folder / "bus");
  hub.serve(steady_ns() + 10'000'000);
  CanFrame urgent{.id = 1, .size = 8, .data = {}, .time_ns = 0},
      other{.id = 0x201, .size = 8, .data = {}, .time_ns = 0};
  int others = 0, all = 0;
  for (const int64_t end = steady_ns() + 300'000'000; steady_ns() < end;) {
    for (int i = 0; i < 50; ++i) babbler.send(urgent);
    sender.send(other);
    hub.serve(0);
    for (Received got; (got = receiver.receive(0)).kind == Received::Kind::kFrame; ++all)
      others += got.frame.id == 0x201;
  }
  EXPECT_GT(all, 500);
  EXPECT_LT(all, 300 * 8 + 32 + 100);
  EXPECT_LE(others, 32) << "only those of the first burst";
  EXPECT_GT(hub.counters().lost, 0u);
}

}  // namespace
}  // namespace edgepose
