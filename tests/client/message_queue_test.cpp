#include "client/service/message_queue.h"

#include <gtest/gtest.h>

#include <thread>

namespace edgepose {
namespace {

using namespace std::chrono_literals;

TimedMessage message(const std::string& channel, size_t size) {
  return {1, {channel, std::make_unique<std::byte[]>(size), size}};
}

SteadyTime soon() { return std::chrono::steady_clock::now() + 10s; }

TEST(MessageQueue, InOrderAndNotBeyondItsBytes) {
  const size_t each = MessageQueue::cost(message("A", 1000).message);
  MessageQueue queue(3 * each);
  EXPECT_TRUE(queue.push(message("A", 1000)));
  EXPECT_TRUE(queue.push(message("B", 1000)));
  EXPECT_TRUE(queue.push(message("C", 1000)));
  EXPECT_FALSE(queue.push(message("D", 0))) << "an empty message takes room as well";
  EXPECT_EQ(queue.dropped(), 1u);
  EXPECT_EQ(queue.bytes(), 3 * each);
  EXPECT_EQ(queue.pop({}, soon())->message.channel, "A");
  EXPECT_TRUE(queue.push(message("E", 1000)));
  EXPECT_EQ(queue.pop({}, soon())->message.channel, "B");
  EXPECT_EQ(queue.pop({}, soon())->message.channel, "C");
  EXPECT_EQ(queue.pop({}, soon())->message.channel, "E");
  EXPECT_EQ(queue.bytes(), 0u);
}

TEST(MessageQueue, WaitsForAMessageADeadlineOrAStop) {
  MessageQueue queue(10'000);
  EXPECT_FALSE(queue.pop({}, std::chrono::steady_clock::now() + 1ms));
  std::jthread sender([&] { queue.push(message("A", 1)); });
  EXPECT_TRUE(queue.pop({}, soon()));
  std::stop_source stop;
  std::jthread stopper([&] { stop.request_stop(); });
  EXPECT_FALSE(queue.pop(stop.get_token(), soon()));
}

TEST(MessageQueue, ClosedItGivesWhatIsLeft) {
  MessageQueue queue(10'000);
  queue.push(message("A", 1));
  queue.close();
  EXPECT_FALSE(queue.push(message("B", 1)));
  EXPECT_EQ(queue.dropped(), 1u);
  EXPECT_TRUE(queue.pop({}, soon()));
  EXPECT_FALSE(queue.pop({}, soon()));
}

}  // namespace
}  // namespace edgepose
