/// The receiver on a real socket, with liblcm and with attackers as senders, in a network of the test's own.
#include "messaging/udpm_receiver.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <chrono>
#include <condition_variable>
#include <lcm/lcm-cpp.hpp>
#include <random>

#include "common/error.h"
#include "tests/messaging/datagrams.h"
#include "tests/messaging/network_namespace.h"

namespace edgepose {
namespace {

using datagrams::Bytes;
using datagrams::bytes_of;
using namespace std::chrono_literals;

const std::string kUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=8388608";

/// What the receiver hands over, for a test to wait for.
class Inbox {
 public:
  UdpmReceiver::Handler handler() {
    return [this](ReceivedMessage&& message) {
      const std::scoped_lock lock(mutex_);
      messages_.push_back(std::move(message));
      changed_.notify_all();
    };
  }
  /// True as soon as there are so many; false after ten seconds.
  bool wait_for(size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 10s, [&] { return messages_.size() >= count; });
  }
  std::vector<ReceivedMessage>& messages() { return messages_; }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<ReceivedMessage> messages_;
};

Bytes random_bytes(size_t size, uint64_t seed) {
  std::mt19937_64 random(seed);
  Bytes bytes(size);
  for (auto& b : bytes) b = static_cast<std::byte>(random() & 0xff);
  return bytes;
}

/// A sender that may send anything to the group.
class Attacker {
 public:
  Attacker() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(7667);
    inet_pton(AF_INET, "239.255.76.67", &to_.sin_addr);
    const unsigned char ttl = 0;
    setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
  }
  Attacker(const Attacker&) = delete;
  Attacker& operator=(const Attacker&) = delete;
  ~Attacker() { close(socket_); }
  void send(const Bytes& datagram) const {
    ASSERT_EQ(sendto(socket_, datagram.data(), datagram.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
                     sizeof(to_)),
              static_cast<ssize_t>(datagram.size()));
  }

 private:
  int socket_;
  sockaddr_in to_{};
};

class UdpmReceiverOnLo : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network())
      GTEST_SKIP() << "needs root or user namespaces, and ip (iproute2), for a network of its own";
  }
};

TEST_F(UdpmReceiverOnLo, HearsWhatLiblcmPublishes) {
  Inbox inbox;
  const UdpmReceiver receiver(parse_udpm_url(kUrl), inbox.handler());
  lcm::LCM publisher(kUrl);
  ASSERT_TRUE(publisher.good());
  const std::vector<size_t> sizes = {0, 1, 1400, 65000, 65499, 65500, 200'000, 737'280, 3'000'000};
  for (size_t i = 0; i < sizes.size(); ++i) {
    const Bytes sent = random_bytes(sizes[i], i);
    ASSERT_EQ(
        publisher.publish("CHANNEL_" + std::to_string(i), sent.data(), static_cast<unsigned>(sent.size())),
        0);
    ASSERT_TRUE(inbox.wait_for(i + 1)) << sizes[i] << " bytes";
    EXPECT_EQ(inbox.messages()[i].channel, "CHANNEL_" + std::to_string(i));
    const auto got = inbox.messages()[i].data();
    EXPECT_EQ(Bytes(got.begin(), got.end()), sent) << sizes[i] << " bytes";
  }
  EXPECT_EQ(receiver.counters().malformed, 0u);
  EXPECT_EQ(receiver.counters().assembly.messages, sizes.size());
}

TEST_F(UdpmReceiverOnLo, SurvivesAttacksAndHearsTheNextMessage) {
  Inbox inbox;
  const UdpmReceiver receiver(parse_udpm_url(kUrl), inbox.handler());
  const Attacker attacker;
  attacker.send(datagrams::fragment({1, 100, 0xfffffff0, 1, 2}, bytes_of("0123")));
  attacker.send(bytes_of("LC020000CHANNEL"));
  attacker.send(bytes_of("LC0"));
  const auto pieces = datagrams::fragments(5, "C", random_bytes(1000, 1), 500);
  for (int i = 0; i < 100; ++i) attacker.send(pieces[0]);
  std::mt19937_64 random(7);
  for (uint32_t i = 0; i < 500; ++i) {
    attacker.send(random_bytes(random() % 100, i));
    attacker.send(
        datagrams::fragment({i + 10, static_cast<uint32_t>(random() % (1u << 31)), 5, 1, 3}, bytes_of("x")));
  }
  attacker.send(datagrams::short_message(9, "GOOD", bytes_of("still here")));
  ASSERT_TRUE(inbox.wait_for(1));
  EXPECT_EQ(inbox.messages()[0].channel, "GOOD");
  const ReceiveCounters counters = receiver.counters();
  EXPECT_GE(counters.malformed, 3u);
  EXPECT_EQ(counters.assembly.duplicates, 99u);
  EXPECT_GT(counters.assembly.given_up, 0u);
}

TEST_F(UdpmReceiverOnLo, EndsAtOnceAndMayBeStartedAgain) {
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) {
    Inbox inbox;
    const UdpmReceiver receiver(parse_udpm_url(kUrl), inbox.handler());
    EXPECT_GT(receiver.receive_buffer_bytes(), 0);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, 5s);
}

TEST_F(UdpmReceiverOnLo, TwoShareThePort) {
  Inbox first, second;
  const UdpmReceiver a(parse_udpm_url(kUrl), first.handler()), b(parse_udpm_url(kUrl), second.handler());
  const Attacker sender;
  sender.send(datagrams::short_message(1, "BOTH", bytes_of("hear")));
  EXPECT_TRUE(first.wait_for(1));
  EXPECT_TRUE(second.wait_for(1));
}

}  // namespace
}  // namespace edgepose
