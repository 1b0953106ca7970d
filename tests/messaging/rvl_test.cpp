#include "messaging/rvl.h"

#include <gtest/gtest.h>

#include <random>

namespace edgepose {
namespace {

/// Smooth surfaces, noise and holes, as a depth camera gives them.
std::vector<uint16_t> depth_like(size_t size, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<uint16_t> depth(size);
  int value = 800;
  for (auto& d : depth) {
    if (random() % 200 == 0) value = 1 + static_cast<int>(random() % 65535);
    value = std::clamp(value + static_cast<int>(random() % 5) - 2, 1, 65535);
    d = random() % 10 == 0 ? uint16_t{0} : static_cast<uint16_t>(value);
  }
  return depth;
}

class Rvl : public testing::TestWithParam<uint64_t> {};

TEST_P(Rvl, ComesBackAsItWas) {
  const auto depth = depth_like(GetParam() * 97, GetParam());
  const auto bytes = encode_rvl(depth);
  std::vector<uint16_t> back(depth.size(), 9);
  ASSERT_TRUE(decode_rvl(bytes, back));
  EXPECT_EQ(back, depth);
}

TEST_P(Rvl, CutOrLongerIsRefused) {
  const auto depth = depth_like(500, GetParam());
  auto bytes = encode_rvl(depth);
  std::vector<uint16_t> back(depth.size());
  for (size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_rvl(std::span(bytes).first(size), back)) << size;
  bytes.resize(bytes.size() + 4);
  EXPECT_FALSE(decode_rvl(bytes, back));
}

INSTANTIATE_TEST_SUITE_P(Seeds, Rvl, testing::Range<uint64_t>(0, 20));

TEST(RvlFormat, IsThatOfThePaper) {
  // Two zeros, then 5, 3: runs 2 and 2, differences +5 and -2, zigzag 10 and 3. Nibbles: 2, 2, a (2 and
  // more), 1, 3.
  const std::vector<uint16_t> depth = {0, 0, 5, 3};
  const std::vector<std::byte> expected = {std::byte{0x00}, std::byte{0x30}, std::byte{0xa1},
                                           std::byte{0x22}};
  EXPECT_EQ(encode_rvl(depth), expected);
}

TEST(RvlFormat, EndlessEmptyRunsAndNumbersAreRefused) {
  std::vector<uint16_t> depth(10);
  EXPECT_FALSE(decode_rvl(std::vector<std::byte>(4096, std::byte{0}), depth));
  EXPECT_FALSE(decode_rvl(std::vector<std::byte>(4096, std::byte{0xff}), depth));
}

TEST(RvlFormat, AnyBytesAreSafe) {
  std::mt19937_64 random(3);
  std::vector<uint16_t> depth(300);
  for (int i = 0; i < 3000; ++i) {
    std::vector<std::byte> bytes(4 * (random() % 40));
    for (auto& b : bytes) b = static_cast<std::byte>(random() & 0xff);
    decode_rvl(bytes, depth);
  }
}

}  // namespace
}  // namespace edgepose
