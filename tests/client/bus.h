#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <vector>

#include "messaging/lcm_publisher.h"
#include "messaging/udpm_receiver.h"
#include "tests/messaging/network_namespace.h"

/// What the tests hear and say on the LCM of a network of their own.
namespace edgepose::test {

/// Hears everything from its making on.
class Bus {
 public:
  using Heard = std::function<void(const ReceivedMessage&)>;

  explicit Bus(Heard heard = {})
      : heard_(std::move(heard)),
        receiver_(parse_udpm_url(kDefaultLcmUrl), [this](ReceivedMessage&& message) {
          if (heard_) heard_(message);
          const std::scoped_lock lock(mutex_);
          messages_.push_back(std::move(message));
          changed_.notify_all();
        }) {}

  bool publish(const std::string& channel, std::span<const std::byte> message) {
    return publisher_.publish(channel, message);
  }

  size_t count(const std::string& channel) {
    const std::scoped_lock lock(mutex_);
    return count_of(channel);
  }
  /// True as soon as there are so many; false after 30 s.
  bool wait_for(const std::string& channel, size_t count) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(30), [&] { return count_of(channel) >= count; });
  }
  /// What has been heard so far.
  std::vector<std::vector<std::byte>> on(const std::string& channel) {
    const std::scoped_lock lock(mutex_);
    std::vector<std::vector<std::byte>> all;
    for (const auto& message : messages_)
      if (message.channel == channel) all.emplace_back(message.data().begin(), message.data().end());
    return all;
  }

 private:
  size_t count_of(const std::string& channel) const {
    return static_cast<size_t>(std::count_if(messages_.begin(), messages_.end(),
                                             [&](const auto& m) { return m.channel == channel; }));
  }
  const Heard heard_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<ReceivedMessage> messages_;
  LcmPublisher publisher_{parse_udpm_url(kDefaultLcmUrl)};
  UdpmReceiver receiver_;  // last: its thread uses the others
};

class OnOwnNetwork : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network())
      GTEST_SKIP() << "needs root or user namespaces, and ip (iproute2), for a network of its own";
  }
};

}  // namespace edgepose::test
