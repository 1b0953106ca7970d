#include "messaging/authentication.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "common/error.h"
#include "tests/messaging/messages.h"

namespace edgepose {
namespace {

std::vector<std::byte> poses() {
  std::mt19937_64 random(1);
  return messages::encoded(messages::pose_estimates(random));
}

TEST(Authentication, EachGenuineMessageCountsOnce) {
  const SecretKey key = SecretKey::random();
  MessageSigner signer(key, 1000);
  MessageVerifier verifier(key);
  auto first = poses(), second = poses();
  signer.sign("POSES", first);
  signer.sign("POSES", second);
  EXPECT_NE(first, second);
  EXPECT_EQ(verifier.judge("POSES", first), Authenticity::kGenuine);
  EXPECT_EQ(verifier.judge("POSES", first), Authenticity::kReplayed);
  EXPECT_EQ(verifier.judge("POSES", second), Authenticity::kGenuine);
  EXPECT_EQ(verifier.judge("POSES", first), Authenticity::kReplayed);
  // Still a message that liblcm's decoders understand.
  edgepose_lcm::pose_estimates_t decoded;
  EXPECT_EQ(decode_checked(std::span<const std::byte>(second), decoded), "");
  EXPECT_EQ(decoded.authentication.session, 1000);
  EXPECT_EQ(decoded.authentication.counter, 2);
}

TEST(Authentication, AnyAlteredByteIsNoticed) {
  const SecretKey key = SecretKey::random();
  MessageSigner signer(key, 1000);
  MessageVerifier verifier(key);
  auto message = poses();
  signer.sign("POSES", message);
  for (size_t i = 0; i < message.size(); ++i) {
    auto altered = message;
    altered[i] ^= std::byte{4};
    EXPECT_EQ(verifier.judge("POSES", altered), Authenticity::kAltered) << i;
  }
  EXPECT_EQ(verifier.judge("POSES", message), Authenticity::kGenuine);
}

TEST(Authentication, AnotherChannelKeyOrNone) {
  const SecretKey key = SecretKey::random();
  MessageSigner signer(key, 1000);
  MessageVerifier verifier(key), stranger(SecretKey::random());
  auto message = poses();
  EXPECT_EQ(verifier.judge("POSES", message), Authenticity::kUnsigned);
  EXPECT_EQ(verifier.judge("POSES", std::span(message).first(20)), Authenticity::kUnsigned);
  signer.sign("POSES", message);
  EXPECT_EQ(verifier.judge("TARGETS", message), Authenticity::kAltered);
  EXPECT_EQ(stranger.judge("POSES", message), Authenticity::kAltered);
}

TEST(Authentication, ARestartedSenderIsHeardAndTheOldOneNoLonger) {
  const SecretKey key = SecretKey::random();
  MessageSigner before(key, 1000), after(key, 2000);
  MessageVerifier verifier(key);
  auto old = poses(), late = poses(), fresh = poses();
  before.sign("POSES", old);
  before.sign("POSES", late);
  after.sign("POSES", fresh);
  EXPECT_EQ(verifier.judge("POSES", old), Authenticity::kGenuine);
  EXPECT_EQ(verifier.judge("POSES", fresh), Authenticity::kGenuine);
  EXPECT_EQ(verifier.judge("POSES", late), Authenticity::kReplayed);
}

class KeyFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(testing::TempDir()) /
              (std::string("key_") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    path_ = folder_ / "key";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  std::string fault() const {
    try {
      SecretKey::read(path_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::filesystem::path folder_, path_;
};

TEST_F(KeyFile, ComesBackAndOnlyItsOwnerCanReadIt) {
  const SecretKey key = SecretKey::random();
  key.write(path_);
  EXPECT_EQ(SecretKey::read(path_).bytes(), key.bytes());
  struct stat state {};
  ASSERT_EQ(stat(path_.c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777, 0600u);
  EXPECT_THROW(key.write(path_), InputError) << "never replaced";
  EXPECT_EQ(SecretKey::read(path_).bytes(), key.bytes());
}

TEST_F(KeyFile, AMissingFolderIsNamed) {
  try {
    SecretKey::random().write(folder_ / "no_folder" / "key");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("no_folder, found none; make it first"));
  }
}

TEST_F(KeyFile, OthersMayNotReadIt) {
  SecretKey::random().write(path_);
  chmod(path_.c_str(), 0644);
  EXPECT_THAT(fault(), testing::HasSubstr("chmod 600"));
  chmod(path_.c_str(), 0640);
  EXPECT_EQ(fault(), "");
}

TEST_F(KeyFile, AnythingElseIsRefused) {
  EXPECT_THAT(fault(), testing::HasSubstr("keygen"));
  for (const std::string& text :
       {std::string(), std::string("edgepose-key-1 abc\n"), std::string(200, 'a'),
        "edgepose-key-1 " + std::string(64, 'g') + "\n", "edgepose-key-2 " + std::string(64, 'a') + "\n"}) {
    std::ofstream(path_) << text;
    chmod(path_.c_str(), 0600);
    EXPECT_THAT(fault(), testing::HasSubstr("64 hex digits")) << text;
  }
}

}  // namespace
}  // namespace edgepose
