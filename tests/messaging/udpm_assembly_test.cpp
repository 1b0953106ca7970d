#include "messaging/udpm_assembly.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/messaging/datagrams.h"

namespace edgepose {
namespace {

using datagrams::Bytes;
using datagrams::bytes_of;
using datagrams::fragment;
using datagrams::fragments;

Bytes random_bytes(size_t size, uint64_t seed) {
  std::mt19937_64 random(seed);
  Bytes bytes(size);
  for (auto& b : bytes) b = static_cast<std::byte>(random() & 0xff);
  return bytes;
}

std::optional<ReceivedMessage> add(UdpmAssembly& assembly, SenderKey sender, const Bytes& datagram,
                                   int64_t now_us = 0) {
  UdpmPacket packet;
  EXPECT_EQ(parse_udpm(datagram, packet), UdpmFault::kNone);
  return assembly.add(sender, packet, now_us);
}

class UdpmAssemblyOrder : public testing::TestWithParam<uint64_t> {};

TEST_P(UdpmAssemblyOrder, AnyOrderAndDuplicatesGiveTheMessageOnce) {
  std::mt19937_64 random(GetParam());
  UdpmAssembly assembly;
  const Bytes message = random_bytes(1 + random() % 5000, GetParam());
  auto pieces = fragments(9, "C", message, 1 + random() % 900);
  if (pieces.size() < 2) pieces = fragments(9, "C", message, message.size() / 2 + 1);
  const auto once = pieces;
  for (size_t i = 0; i + 1 < once.size(); i += 2) pieces.push_back(once[i]);
  std::shuffle(pieces.begin(), pieces.end(), random);
  size_t delivered = 0;
  for (const Bytes& piece : pieces) {
    const auto whole = add(assembly, 1, piece);
    if (!whole) continue;
    ++delivered;
    EXPECT_EQ(whole->channel, "C");
    EXPECT_EQ(Bytes(whole->data().begin(), whole->data().end()), message);
  }
  EXPECT_EQ(delivered, 1u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, UdpmAssemblyOrder, testing::Range<uint64_t>(1, 40));

TEST(UdpmAssembly, SendersDoNotMix) {
  UdpmAssembly assembly;
  const auto a = fragments(5, "A", bytes_of("aaaabbbb"), 4), b = fragments(5, "B", bytes_of("ccccdddd"), 4);
  EXPECT_FALSE(add(assembly, 1, a[0]));
  EXPECT_FALSE(add(assembly, 2, b[1]));
  const auto first = add(assembly, 1, a[1]), second = add(assembly, 2, b[0]);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->channel, "A");
  EXPECT_EQ(Bytes(second->data().begin(), second->data().end()), bytes_of("ccccdddd"));
  EXPECT_EQ(assembly.unfinished(), 0u);
  EXPECT_EQ(assembly.bytes(), 0u);
}

TEST(UdpmAssembly, GapsAndOverlapsAreNotDelivered) {
  // Two fragments of the right total that leave a hole: liblcm delivers memory that nobody wrote.
  UdpmAssembly assembly;
  EXPECT_FALSE(add(assembly, 1,
                   fragment({1, 8, 0, 0, 3}, bytes_of(std::string("C\0"
                                                                  "0123",
                                                                  6)))));
  EXPECT_FALSE(add(assembly, 1, fragment({1, 8, 2, 1, 3}, bytes_of("45"))));
  EXPECT_FALSE(add(assembly, 1, fragment({1, 8, 6, 2, 3}, bytes_of("67"))));
  EXPECT_EQ(assembly.counters().refused, 1u);
  EXPECT_EQ(assembly.unfinished(), 0u);
}

TEST(UdpmAssembly, FragmentsThatContradictEachOtherAreRefused) {
  UdpmAssembly assembly;
  const auto good = fragments(1, "C", bytes_of("01234567"), 4);
  EXPECT_FALSE(add(assembly, 1, good[0]));
  EXPECT_FALSE(add(assembly, 1, fragment({1, 9, 4, 1, 2}, bytes_of("45678"))));
  EXPECT_FALSE(add(assembly, 1, fragment({1, 8, 4, 1, 3}, bytes_of("4567"))));
  EXPECT_EQ(assembly.counters().refused, 2u);
  EXPECT_TRUE(add(assembly, 1, good[1]));
}

TEST(UdpmAssembly, MemoryStaysBoundedWhateverIsAnnounced) {
  AssemblyOptions options;
  options.max_bytes = 1 << 20;
  options.max_message_bytes = 400 << 10;
  UdpmAssembly assembly(options);
  std::mt19937_64 random(1);
  for (int i = 0; i < 5000; ++i) {
    const auto size = static_cast<uint32_t>(10 + random() % (600u << 10));
    add(assembly, random() % 500, fragment({static_cast<uint32_t>(random()), size, 5, 1, 7}, bytes_of("x")));
    ASSERT_LE(assembly.bytes(), options.max_bytes);
    ASSERT_LE(assembly.unfinished(), options.max_unfinished);
  }
  EXPECT_GT(assembly.counters().given_up, 0u);
  EXPECT_GT(assembly.counters().refused, 0u);
}

TEST(UdpmAssembly, AFloodOfOneSenderDoesNotCostAnotherItsMessage) {
  AssemblyOptions options;
  options.max_bytes = 1 << 20;
  options.max_message_bytes = 400 << 10;
  UdpmAssembly assembly(options);
  const auto good = fragments(1, "C", bytes_of("01234567"), 4);
  EXPECT_FALSE(add(assembly, 1, good[0]));
  for (uint32_t i = 0; i < 1000; ++i) add(assembly, 2, fragment({i, 400 << 10, 5, 1, 7}, bytes_of("x")));
  EXPECT_TRUE(add(assembly, 1, good[1]));
}

TEST(UdpmAssembly, WhatStaysIncompleteIsGivenUp) {
  UdpmAssembly assembly;
  add(assembly, 1, fragments(1, "C", bytes_of("01234567"), 4)[0], 0);
  add(assembly, 2, fragments(1, "C", bytes_of("01234567"), 4)[0], 2'000'000);
  EXPECT_EQ(assembly.counters().given_up, 1u);
  EXPECT_EQ(assembly.unfinished(), 1u);
}

TEST(UdpmAssembly, OptionsAreChecked) {
  AssemblyOptions options;
  EXPECT_EQ(options.check(), "");
  options.max_per_sender = 0;
  EXPECT_NE(options.check().find("max_per_sender"), std::string::npos);
}

}  // namespace
}  // namespace edgepose
