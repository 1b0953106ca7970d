#include "messaging/signed_command.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr int64_t kStart = 1'700'000'000'000'000, kNow = kStart + 100'000'000;
const std::string kRequest = R"({"jsonrpc":"2.0","id":1,"method":"shutdown"})";

TEST(SignedCommand, ComesBackFromItsLine) {
  const SecretKey key = SecretKey::random();
  const SignedCommand sent = sign(key, kRequest, kNow - 5, 3, kNow);
  const std::string line = to_line(sent);
  EXPECT_EQ(line.find('\n'), std::string::npos);
  SignedCommand read;
  ASSERT_EQ(parse_signed_command(line, read), "");
  EXPECT_EQ(read.text, kRequest);
  EXPECT_EQ(read.session, kNow - 5);
  EXPECT_EQ(read.counter, 3);
  EXPECT_EQ(read.utime, kNow);
  EXPECT_TRUE(verify(key, read));
}

TEST(SignedCommand, WhateverIsAlteredIsNoticed) {
  const SecretKey key = SecretKey::random();
  const SignedCommand sent = sign(key, kRequest, kNow - 5, 3, kNow);
  const auto altered = [&](auto change) {
    SignedCommand command = sent;
    change(command);
    return !verify(key, command);
  };
  EXPECT_TRUE(altered([](SignedCommand& c) { c.text[3] ^= 1; }));
  EXPECT_TRUE(altered([](SignedCommand& c) { c.text += ' '; }));
  EXPECT_TRUE(altered([](SignedCommand& c) { ++c.session; }));
  EXPECT_TRUE(altered([](SignedCommand& c) { ++c.counter; }));
  EXPECT_TRUE(altered([](SignedCommand& c) { ++c.utime; }));
  for (size_t i = 0; i < sent.tag.size(); ++i)
    EXPECT_TRUE(altered([&](SignedCommand& c) { c.tag[i] = c.tag[i] == '0' ? '1' : '0'; })) << i;
  EXPECT_TRUE(altered([](SignedCommand& c) { c.tag.pop_back(); }));
  EXPECT_TRUE(altered([](SignedCommand& c) { c.tag.clear(); }));
  EXPECT_FALSE(verify(SecretKey::random(), sent));
  EXPECT_FALSE(altered([](SignedCommand&) {}));
}

TEST(SignedCommand, WhatIsNoEnvelopeIsRefused) {
  const std::string tag(64, 'a'), end = R"(,"tag":")" + tag + "\"}";
  SignedCommand command;
  ASSERT_EQ(parse_signed_command(R"({"signed":"x","session":1,"counter":1,"utime":1)" + end, command), "");
  const std::vector<std::string> others = {
      std::string(),
      std::string("nonsense"),
      std::string("[]"),
      std::string("{}"),
      kRequest,
      std::string(60000, '['),
      R"({"signed":{},"session":1,"counter":1,"utime":1)" + end,
      R"({"signed":"x\u0000y","session":1,"counter":1,"utime":1)" + end,
      R"({"signed":"x","session":-1,"counter":1,"utime":1)" + end,
      R"({"signed":"x","session":1,"counter":0,"utime":1)" + end,
      R"({"signed":"x","session":1,"counter":1.5,"utime":1)" + end,
      R"({"signed":"x","session":1,"counter":1,"utime":9223372036854775808)" + end,
      R"({"signed":"x","session":1,"counter":1,"utime":"1")" + end,
      R"({"signed":"x","session":1,"counter":1,"utime":1,"more":1)" + end,
      R"({"signed":"x","session":1,"counter":1,"utime":1,"tag":"AA"})",
      std::string(R"({"signed":"x","session":1,"counter":1,"utime":1})")};
  for (const std::string& line : others)
    EXPECT_THAT(parse_signed_command(line, command), testing::HasSubstr("expected")) << line.substr(0, 80);
}

TEST(SignedCommand, OtherBytesThanUtf8AreNotSent) {
  EXPECT_THROW(to_line(sign(SecretKey::random(), "\xff", 1, 1, 1)), InputError);
}

TEST(CommandVerifier, EachGenuineCommandCountsOnce) {
  const SecretKey key = SecretKey::random();
  CommandVerifier verifier(key, kStart);
  const auto first = sign(key, kRequest, kNow - 5, 1, kNow), second = sign(key, kRequest, kNow - 5, 2, kNow);
  EXPECT_EQ(verifier.judge(first, kNow + 1), CommandFault::kNone);
  EXPECT_EQ(verifier.judge(first, kNow + 2), CommandFault::kReplayed);
  EXPECT_EQ(verifier.judge(second, kNow + 3), CommandFault::kNone);
  EXPECT_EQ(verifier.judge(first, kNow + 4), CommandFault::kReplayed);
  EXPECT_EQ(verifier.judge(sign(key, kRequest, kNow - 4, 1, kNow), kNow), CommandFault::kNone);
  EXPECT_EQ(verifier.judge(sign(key, kRequest, kNow - 5, 9, kNow), kNow), CommandFault::kReplayed);
  EXPECT_EQ(verifier.judge(sign(SecretKey::random(), kRequest, kNow, 1, kNow), kNow), CommandFault::kAltered);
}

TEST(CommandVerifier, WhatIsOldOrOfTheFutureIsRefusedAndShutsNobodyOut) {
  const SecretKey key = SecretKey::random();
  CommandVerifier verifier(key, kStart);
  const auto signed_at = [&](int64_t session, int64_t utime) {
    return sign(key, kRequest, session, 1, utime);
  };
  EXPECT_EQ(verifier.judge(signed_at(kStart - 9, kStart - 1), kStart + 1), CommandFault::kOld);
  EXPECT_EQ(verifier.judge(signed_at(kNow, kNow), kNow + CommandVerifier::kMaxAge + 1), CommandFault::kOld);
  EXPECT_EQ(verifier.judge(signed_at(kNow, kNow + CommandVerifier::kMaxAhead + 1), kNow), CommandFault::kOld);
  EXPECT_EQ(verifier.judge(signed_at(INT64_MAX, kNow), kNow), CommandFault::kOld);
  EXPECT_EQ(verifier.judge(signed_at(kNow, kNow), kNow + CommandVerifier::kMaxAge), CommandFault::kNone);
}

}  // namespace
}  // namespace edgepose
