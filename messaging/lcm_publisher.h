#pragma once
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "messaging/authentication.h"
#include "messaging/udpm_address.h"

namespace edgepose {

/// Publishes over LCM's UDP multicast (liblcm). Safe from any thread. Nothing tells whether anybody has
/// received anything.
class LcmPublisher {
 public:
  /// Throws InputError if there is no route to the group.
  explicit LcmPublisher(const UdpmAddress& address);
  ~LcmPublisher();

  /// False if the system refused to send it.
  bool publish(const std::string& channel, std::span<const std::byte> message);

 private:
  struct Lcm;
  std::unique_ptr<Lcm> lcm_;
};

/// The message's bytes as they are sent.
template <class Message>
std::vector<std::byte> encode(const Message& message) {
  const int size = message.getEncodedSize();
  std::vector<std::byte> bytes(static_cast<size_t>(size));
  if (message.encode(bytes.data(), 0, size) != size) throw std::length_error("a message of another size");
  return bytes;
}

}  // namespace edgepose
