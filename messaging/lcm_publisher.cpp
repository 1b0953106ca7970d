#include "messaging/lcm_publisher.h"

#include <lcm/lcm.h>

#include "common/error.h"

namespace edgepose {

struct LcmPublisher::Lcm {
  explicit Lcm(const std::string& url) : handle(lcm_create(url.c_str())) {}
  Lcm(const Lcm&) = delete;
  Lcm& operator=(const Lcm&) = delete;
  ~Lcm() {
    if (handle != nullptr) lcm_destroy(handle);
  }
  lcm_t* handle;
};

LcmPublisher::LcmPublisher(const UdpmAddress& address) : lcm_(std::make_unique<Lcm>(to_url(address))) {
  if (lcm_->handle == nullptr)
    throw InputError::at(to_url(address), "a multicast group that can be sent to", "no route",
                         "ip route add 224.0.0.0/4 dev lo");
}

LcmPublisher::~LcmPublisher() = default;

bool LcmPublisher::publish(const std::string& channel, std::span<const std::byte> message) {
  return lcm_publish(lcm_->handle, channel.c_str(), message.data(), static_cast<unsigned>(message.size())) ==
         0;
}

}  // namespace edgepose
