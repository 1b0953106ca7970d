#include "client/service/message_queue.h"

namespace edgepose {

size_t MessageQueue::cost(const ReceivedMessage& message) {
  constexpr size_t kOverhead = 200;
  return kOverhead + message.channel.size() + message.size;
}

bool MessageQueue::push(TimedMessage&& message) {
  const std::scoped_lock lock(mutex_);
  const size_t more = cost(message.message);
  if (closed_ || bytes_ + more > max_bytes_) {
    ++dropped_;
    return false;
  }
  bytes_ += more;
  messages_.push_back(std::move(message));
  changed_.notify_one();
  return true;
}

std::optional<TimedMessage> MessageQueue::pop(const std::stop_token& stop, SteadyTime deadline) {
  std::unique_lock lock(mutex_);
  changed_.wait_until(lock, stop, deadline, [&] { return closed_ || !messages_.empty(); });
  if (messages_.empty()) return std::nullopt;
  TimedMessage message = std::move(messages_.front());
  messages_.pop_front();
  bytes_ -= cost(message.message);
  return message;
}

void MessageQueue::close() {
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  changed_.notify_all();
}

bool MessageQueue::is_closed() const {
  const std::scoped_lock lock(mutex_);
  return closed_;
}

uint64_t MessageQueue::dropped() const {
  const std::scoped_lock lock(mutex_);
  return dropped_;
}

size_t MessageQueue::bytes() const {
  const std::scoped_lock lock(mutex_);
  return bytes_;
}

}  // namespace edgepose
