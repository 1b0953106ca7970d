#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace edgepose {

/// The secret that sender and receivers share (libsodium's crypto_auth). Wiped from memory when it goes.
class SecretKey {
 public:
  static constexpr size_t kBytes = 32;

  static SecretKey random();
  /// Reads a file of one line, "edgepose-key-1 " and 64 hex digits. Throws InputError: missing, another
  /// content, or readable by others than its owner and group (mode beyond 0640).
  static SecretKey read(const std::filesystem::path& path);
  /// Writes it with mode 0600; refuses to replace a file.
  void write(const std::filesystem::path& path) const;

  SecretKey(const SecretKey&) = default;
  SecretKey& operator=(const SecretKey&) = default;
  ~SecretKey();
  const std::array<unsigned char, kBytes>& bytes() const { return bytes_; }

 private:
  SecretKey() = default;
  std::array<unsigned char, kBytes> bytes_{};
};

/// Bytes of authentication_t, which ends every message that is signed: session, counter, tag.
inline constexpr size_t kAuthenticationBytes = 48;

/// Signs encoded messages in place. One signer a process and channel. Not thread-safe.
class MessageSigner {
 public:
  /// `session`: [us] since 1970, later than any before it of this sender.
  MessageSigner(const SecretKey& key, int64_t session) : key_(key), session_(session) {}

  /// Fills in the last kAuthenticationBytes of `message`.
  void sign(const std::string& channel, std::span<std::byte> message);

 private:
  SecretKey key_;
  int64_t session_;
  std::map<std::string, int64_t> counters_;  // the last of each channel
};

/// What a receiver thinks of a message's signature.
enum class Authenticity {
  kGenuine,
  kUnsigned,  ///< no tag
  kAltered,   ///< the tag is not this message's: changed, another channel's or another key's
  kReplayed,  ///< genuine, but not newer than one that has come before
};

/// Judges encoded messages. A genuine message counts as come: the same one is replayed from then on. Not
/// thread-safe.
class MessageVerifier {
 public:
  explicit MessageVerifier(const SecretKey& key) : key_(key) {}

  Authenticity judge(const std::string& channel, std::span<const std::byte> message);

 private:
  struct Newest {
    int64_t session = 0, counter = 0;
  };
  SecretKey key_;
  std::map<std::string, Newest> newest_;  // of each channel; only genuine messages make an entry
};

}  // namespace edgepose
