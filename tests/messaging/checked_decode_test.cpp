#include "messaging/checked_decode.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "messaging/big_endian.h"
#include "tests/messaging/messages.h"

namespace edgepose {
namespace {

using Bytes = std::vector<std::byte>;

/// What holds for every type: whole messages are decoded, and no cut, extension or lying length gets through.
template <class Message>
void check_type(const Message& message) {
  const Bytes bytes = messages::encoded(message);
  Message decoded;
  ASSERT_EQ(decode_checked(bytes, decoded), "");
  EXPECT_EQ(messages::encoded(decoded), bytes);

  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_NE(decode_checked(std::span(bytes).first(size), decoded), "") << "cut to " << size;
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_THAT(decode_checked(std::span<const std::byte>(longer), decoded),
              testing::HasSubstr("1 more bytes"));
  Bytes other = bytes;
  other[0] ^= std::byte{1};
  EXPECT_THAT(decode_checked(std::span<const std::byte>(other), decoded), testing::HasSubstr("fingerprint"));

  // Any four bytes may be a length: none may make the decoder allocate or crash.
  for (size_t at = 8; at + 4 <= bytes.size(); ++at)
    for (const int32_t lie : {-1, 0x7fffffff, 0x20000000, INT32_MIN, 1000}) {
      Bytes altered = bytes;
      write_big_endian<int32_t>(lie, altered, at);
      decode_checked(std::span<const std::byte>(altered), decoded);
    }
}

class CheckedDecode : public testing::TestWithParam<uint64_t> {};

TEST_P(CheckedDecode, TakesWholeMessagesOnly) {
  std::mt19937_64 random(GetParam());
  check_type(messages::depth_frame(random));
  check_type(messages::cloud_frame(random));
  check_type(messages::pose_estimates(random));
  check_type(messages::drill_targets(random));
  check_type(messages::service_status(random));
}

INSTANTIATE_TEST_SUITE_P(Seeds, CheckedDecode, testing::Range<uint64_t>(1, 8));

TEST(CheckedDecode, ALengthBeyondTheMessageIsNotAllocated) {
  // liblcm's own decoder allocates 2 GB for this before it looks at what there is.
  std::mt19937_64 random(1);
  auto message = messages::depth_frame(random);
  message.data.clear();
  message.size = 0;
  Bytes bytes = messages::encoded(message);
  write_big_endian<int32_t>(0x7fffffff, bytes, bytes.size() - 4);
  edgepose_lcm::depth_frame_t decoded;
  EXPECT_THAT(decode_checked(std::span<const std::byte>(bytes), decoded), testing::HasSubstr("2147483647"));
}

TEST(CheckedDecode, NamesTheFieldThatIsTooLong) {
  std::mt19937_64 random(1);
  auto message = messages::depth_frame(random);
  message.camera = std::string(64, 'c');
  edgepose_lcm::depth_frame_t decoded;
  EXPECT_THAT(decode_checked(std::span<const std::byte>(messages::encoded(message)), decoded),
              testing::HasSubstr("camera: expected at most 63 bytes, found the length 64"));
}

}  // namespace
}  // namespace edgepose
