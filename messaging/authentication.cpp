#include "messaging/authentication.h"

#include <sodium.h>

#include <algorithm>
#include <tuple>

#include "messaging/big_endian.h"

namespace edgepose {
namespace {

constexpr size_t kTagAt = 16;  // in authentication_t
static_assert(kAuthenticationBytes == kTagAt + crypto_auth_BYTES);
static_assert(SecretKey::kBytes == crypto_auth_KEYBYTES);

/// What is signed: the channel as well, so that a genuine message cannot be moved to another.
std::vector<unsigned char> signed_text(const std::string& channel, std::span<const std::byte> message) {
  std::vector<unsigned char> text(channel.begin(), channel.end());
  text.push_back(0);
  const auto body = message.first(message.size() - kAuthenticationBytes + kTagAt);
  std::transform(body.begin(), body.end(), std::back_inserter(text),
                 [](std::byte b) { return std::to_integer<unsigned char>(b); });
  return text;
}

}  // namespace

void MessageSigner::sign(const std::string& channel, std::span<std::byte> message) {
  const auto authentication = message.last(kAuthenticationBytes);
  write_big_endian(session_, authentication, 0);
  write_big_endian(++counters_[channel], authentication, sizeof(int64_t));
  const auto text = signed_text(channel, message);
  crypto_auth(reinterpret_cast<unsigned char*>(authentication.data() + kTagAt), text.data(), text.size(),
              key_.bytes().data());
}

Authenticity MessageVerifier::judge(const std::string& channel, std::span<const std::byte> message) {
  if (message.size() < kAuthenticationBytes) return Authenticity::kUnsigned;
  const auto authentication = message.last(kAuthenticationBytes);
  const auto tag = authentication.subspan(kTagAt);
  if (std::all_of(tag.begin(), tag.end(), [](std::byte b) { return b == std::byte{0}; }))
    return Authenticity::kUnsigned;
  const auto text = signed_text(channel, message);
  if (crypto_auth_verify(reinterpret_cast<const unsigned char*>(tag.data()), text.data(), text.size(),
                         key_.bytes().data()) != 0)
    return Authenticity::kAltered;
  const auto session = read_big_endian<int64_t>(authentication, 0);
  const auto counter = read_big_endian<int64_t>(authentication, sizeof(int64_t));
  Newest& newest = newest_[channel];
  if (std::tie(session, counter) <= std::tie(newest.session, newest.counter)) return Authenticity::kReplayed;
  newest = {session, counter};
  return Authenticity::kGenuine;
}

}  // namespace edgepose
