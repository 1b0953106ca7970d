#include "messaging/udpm_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"

namespace edgepose {
namespace {

std::string fault_of(const std::string& url) {
  try {
    parse_udpm_url(url);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(UdpmAddress, OfLiblcmsUrls) {
  const UdpmAddress address = parse_udpm_url("udpm://239.255.76.67:7667?ttl=1&recv_buf_size=1048576");
  EXPECT_EQ(address.group, 0xefff4c43u);
  EXPECT_EQ(address.port, 7667);
  EXPECT_EQ(address.ttl, 1);
  EXPECT_EQ(address.receive_buffer_bytes, 1 << 20);
  EXPECT_EQ(parse_udpm_url("udpm://239.0.0.1:1").ttl, 0);
  EXPECT_EQ(fault_of(kDefaultLcmUrl), "");
}

TEST(UdpmAddress, WhatIsWrongIsNamed) {
  EXPECT_THAT(fault_of("tcpq://localhost"), testing::HasSubstr("udpm://"));
  EXPECT_THAT(fault_of("udpm://10.0.0.1:7667"), testing::HasSubstr("10.0.0.1"));
  EXPECT_THAT(fault_of("udpm://239.255.76.67"), testing::HasSubstr("port"));
  EXPECT_THAT(fault_of("udpm://239.255.76.67:70000"), testing::HasSubstr("70000"));
  EXPECT_THAT(fault_of("udpm://239.255.76.67:7667?ttl=256"), testing::HasSubstr("ttl"));
  EXPECT_THAT(fault_of("udpm://239.255.76.67:7667?tttl=1"), testing::HasSubstr("tttl"));
  EXPECT_THAT(fault_of("udpm://239.255.76.67:7667?ttl"), testing::HasSubstr("ttl"));
}

}  // namespace
}  // namespace edgepose
