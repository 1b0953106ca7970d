#include "messaging/udpm_packet.h"

#include <gtest/gtest.h>

#include "tests/messaging/datagrams.h"

namespace edgepose {
namespace {

using datagrams::Bytes;
using datagrams::bytes_of;
using datagrams::fragment;
using datagrams::short_message;

UdpmFault fault_of(const Bytes& datagram) {
  UdpmPacket packet;
  return parse_udpm(datagram, packet);
}

TEST(UdpmPacket, ShortMessage) {
  const Bytes datagram = short_message(7, "EDGEPOSE_DEPTH", bytes_of("payload"));
  UdpmPacket packet;
  ASSERT_EQ(parse_udpm(datagram, packet), UdpmFault::kNone);
  EXPECT_EQ(packet.sequence, 7u);
  EXPECT_EQ(packet.channel, "EDGEPOSE_DEPTH");
  EXPECT_EQ(packet.message_size, 7u);
  EXPECT_EQ(Bytes(packet.payload.begin(), packet.payload.end()), bytes_of("payload"));
}

TEST(UdpmPacket, FragmentsHaveTheChannelInTheFirstOnly) {
  const auto all = datagrams::fragments(3, "CHANNEL", bytes_of("0123456789"), 4);
  ASSERT_EQ(all.size(), 3u);
  UdpmPacket packet;
  ASSERT_EQ(parse_udpm(all[0], packet), UdpmFault::kNone);
  EXPECT_EQ(packet.channel, "CHANNEL");
  ASSERT_EQ(parse_udpm(all[2], packet), UdpmFault::kNone);
  EXPECT_EQ(packet.channel, "");
  EXPECT_EQ(packet.offset, 8u);
  EXPECT_EQ(packet.fragment, 2u);
  EXPECT_EQ(packet.fragments, 3u);
  EXPECT_EQ(Bytes(packet.payload.begin(), packet.payload.end()), bytes_of("89"));
}

TEST(UdpmPacket, TooShortOrForeign) {
  EXPECT_EQ(fault_of({}), UdpmFault::kTooShort);
  EXPECT_EQ(fault_of(bytes_of("LC02123")), UdpmFault::kTooShort);
  EXPECT_EQ(fault_of(bytes_of("LC03 19 bytes are 1")), UdpmFault::kTooShort);
  EXPECT_EQ(fault_of(bytes_of("LC04 and what else?")), UdpmFault::kWrongMagic);
}

TEST(UdpmPacket, ChannelWithoutEndOrSense) {
  // liblcm delivers a short packet without a NUL with a data size of 0xfffffff2.
  EXPECT_EQ(fault_of(bytes_of("LC020000CHANNEL")), UdpmFault::kBadChannel);
  EXPECT_EQ(fault_of(bytes_of("LC020000")), UdpmFault::kBadChannel);
  EXPECT_EQ(fault_of(short_message(1, "", bytes_of("x"))), UdpmFault::kBadChannel);
  EXPECT_EQ(fault_of(short_message(1, std::string(63, 'a'), {})), UdpmFault::kNone);
  EXPECT_EQ(fault_of(short_message(1, std::string(64, 'a'), {})), UdpmFault::kBadChannel);
  EXPECT_EQ(fault_of(short_message(1, "line\nbreak", {})), UdpmFault::kBadChannel);
}

TEST(UdpmPacket, FragmentsThatContradictThemselves) {
  const Bytes rest = bytes_of("0123");
  EXPECT_EQ(fault_of(fragment({1, 100, 50, 1, 2}, rest)), UdpmFault::kNone);
  // An offset that liblcm copies to, out of bounds.
  EXPECT_EQ(fault_of(fragment({1, 100, 0xfffffff0, 1, 2}, rest)), UdpmFault::kBadFragment);
  EXPECT_EQ(fault_of(fragment({1, 100, 97, 1, 2}, rest)), UdpmFault::kBadFragment);
  EXPECT_EQ(fault_of(fragment({1, 0xffffffff, 0xfffffffe, 1, 2}, rest)), UdpmFault::kBadFragment);
  EXPECT_EQ(fault_of(fragment({1, 100, 50, 2, 2}, rest)), UdpmFault::kBadFragment);
  EXPECT_EQ(fault_of(fragment({1, 100, 50, 0, 0}, bytes_of(std::string("C\0x", 3)))),
            UdpmFault::kBadFragment);
  EXPECT_EQ(fault_of(fragment({1, 100, 50, 1, 2}, {})), UdpmFault::kBadFragment);
  EXPECT_EQ(fault_of(fragment({1, 100, 0, 1, 2}, rest)), UdpmFault::kBadFragment);
}

}  // namespace
}  // namespace edgepose
