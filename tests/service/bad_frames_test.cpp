/// Bad input over the network: each is counted by its cause, and the daemon goes on.
#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <random>

#include "tests/messaging/datagrams.h"
#include "tests/service/daemon_fixture.h"

namespace edgepose {
namespace {

using test::DaemonTest;
using test::eventually;

class BadFrames : public DaemonTest {
 protected:
  void SetUp() override {
    DaemonTest::SetUp();
    if (IsSkipped()) return;
    start();
    register_phantom();
  }
  edgepose_lcm::depth_frame_t sound() {
    auto message = pack(scene()[0].depth, 0.0001, DepthEncoding::kRvl);
    message.camera = "other";
    message.sequence = ++sequence_;
    message.capture_utime = test::utime_now();
    return message;
  }
  /// Sends a frame that `spoil` has changed; the cause is counted, and the next sound frame is answered.
  template <class Spoil>
  void expect_counted(const std::string& cause, const Spoil& spoil) {
    peer_->send_as_is(sound());
    auto bad = sound();
    spoil(bad);
    peer_->send_as_is(bad);
    EXPECT_TRUE(eventually([&] { return daemon_->counter("frames_refused_" + cause) > 0; })) << cause;
    EXPECT_THAT(daemon_->log(), testing::HasSubstr("event=frame_refused cause=" + cause));
    EXPECT_TRUE(pose_in(peer_->answer_to(peer_->send(scene()[0].depth)))) << "after " << cause;
  }
  int64_t sequence_ = 1000;
};

TEST_F(BadFrames, EachHasItsCounterAndItsLine) {
  expect_counted("unknown_encoding", [](auto& m) { m.encoding = 9; });
  expect_counted("wrong_size", [](auto& m) { m.height = 5000; });
  expect_counted("too_many_pixels", [](auto& m) { m.height = 100000; });
  expect_counted("wrong_checksum", [](auto& m) { m.checksum ^= 1; });
  expect_counted("from_the_future", [](auto& m) { m.capture_utime += 3'600'000'000; });
  expect_counted("too_old", [](auto& m) { m.capture_utime -= 3'600'000'000; });
  expect_counted("sequence_went_back", [](auto& m) { m.sequence = 1; });
  expect_counted("bad_intrinsics", [](auto& m) { m.fx = m.fy = 0; });
  expect_counted("no_measurement", [this](auto& m) {
    DepthFrame zeros = scene()[0].depth;
    zeros.image.depth.assign(zeros.image.depth.size(), 0);
    const auto packed = pack(zeros, 0.0001, DepthEncoding::kRvl);
    m.data = packed.data, m.size = packed.size, m.checksum = packed.checksum;
  });
  expect_counted("bad_compressed_data", [](auto& m) {
    m.data.assign(100, 0xff);
    m.size = 100;
    m.checksum = 0x2d2b4eb4;  // found below if this is not it
    DepthFrame ignored;
    std::string detail;
    if (unpack(m, ignored, detail) == FrameFault::kChecksum)
      m.checksum = std::stoll(detail.substr(detail.rfind(' ') + 1));
  });
}

/// The five attacks of docs/lcm.md on the running daemon, and noise.
TEST_F(BadFrames, AttacksDoNothing) {
  const int attacker = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(7667);
  inet_pton(AF_INET, "239.255.76.67", &to.sin_addr);
  const auto send = [&](const datagrams::Bytes& bytes) {
    sendto(attacker, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
  };
  // 1: a length that makes a decoder allocate gigabytes.
  auto huge = encode(sound());
  for (size_t i = 8; i < 34 && i < huge.size(); ++i) huge[i] = std::byte{0x7f};
  huge.resize(34);
  send(datagrams::short_message(1, "EDGEPOSE_DEPTH", huge));
  // 2: what makes a typed handler throw, twice, as the second kills liblcm's program.
  for (uint32_t i = 0; i < 2; ++i)
    send(datagrams::short_message(2 + i, "EDGEPOSE_DEPTH", datagrams::bytes_of("x")));
  // 3 to 5: offsets out of bounds, a channel without an end, duplicates instead of the rest.
  send(datagrams::fragment({9, 100, 0xfffffff0, 1, 2}, datagrams::bytes_of("0123")));
  send(datagrams::bytes_of("LC020000EDGEPOSE_DEPTH"));
  const auto pieces = datagrams::fragments(10, "EDGEPOSE_DEPTH", datagrams::Bytes(5000), 1000);
  for (int i = 0; i < 10; ++i) send(pieces[0]);
  std::mt19937_64 random(3);
  for (int i = 0; i < 3000; ++i) {
    datagrams::Bytes noise(random() % 200);
    for (auto& b : noise) b = static_cast<std::byte>(random() & 0xff);
    send(noise);
    send(datagrams::fragment({static_cast<uint32_t>(100 + i), 30'000'000, 0, 0, 500}, noise));
  }
  close(attacker);
  ASSERT_TRUE(eventually([&] { return daemon_->counter("frames_refused_malformed") >= 3; }));
  EXPECT_TRUE(eventually([&] { return daemon_->counter("datagrams_malformed") > 100; }));
  EXPECT_TRUE(pose_in(peer_->answer_to(peer_->send(scene()[0].depth)))) << daemon_->log();
  EXPECT_LT(daemon_->result("stats")["memory_bytes"].get<double>(), 400e6)
      << "unfinished messages are bounded";
}

TEST_F(BadFrames, NewestWinsUnderOverload) {
  // Far more than can be looked at: every frame is answered or told as dropped, and answers stay fresh.
  const int64_t first = peer_->send(scene()[0].depth);
  int64_t last = first;
  for (int i = 0; i < 200; ++i) last = peer_->send(scene()[static_cast<size_t>(i) % scene().size()].depth);
  ASSERT_TRUE(peer_->answer_to(last));
  int64_t accounted = 0;
  for (const auto& [sequence, answer] : peer_->answers()) {
    ++accounted;
    for (const auto& cause : answer.poses.dropped) accounted += cause.value;
  }
  EXPECT_EQ(accounted, last - first + 1);
}

}  // namespace
}  // namespace edgepose
