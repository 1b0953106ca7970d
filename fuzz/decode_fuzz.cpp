#include "fuzz/input_check.h"
#include "messaging/big_endian.h"
#include "messaging/checked_decode.h"

#include <vector>

namespace {

using namespace edgepose;

/// What is decoded encodes to the same bytes, but for flags, of which any value but 0 is true.
template <class Message>
void decode(std::vector<std::byte> bytes) {
  if (bytes.size() >= 8) write_big_endian<int64_t>(Message::getHash(), bytes, 0);
  Message message;
  if (!decode_checked(std::span<const std::byte>(bytes), message).empty()) return;
  must_hold(message.getEncodedSize() == static_cast<int>(bytes.size()));
}

}  // namespace

// The first byte chooses the type.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  const auto all = std::as_bytes(std::span(data, size));
  const std::vector<std::byte> bytes(all.begin() + 1, all.end());
  switch (data[0] % 5) {
    case 0:
      decode<edgepose_lcm::depth_frame_t>(bytes);
      break;
    case 1:
      decode<edgepose_lcm::cloud_frame_t>(bytes);
      break;
    case 2:
      decode<edgepose_lcm::pose_estimates_t>(bytes);
      break;
    case 3:
      decode<edgepose_lcm::drill_targets_t>(bytes);
      break;
    default:
      decode<edgepose_lcm::service_status_t>(bytes);
      break;
  }
  return 0;
}
