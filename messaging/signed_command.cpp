#include "messaging/signed_command.h"

#include <sodium.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "common/error.h"

namespace edgepose {
namespace {

using nlohmann::json;
using Tag = std::array<unsigned char, crypto_auth_BYTES>;

constexpr size_t kTagDigits = 2 * crypto_auth_BYTES;

/// The numbers follow a zero byte, which no JSON text has: no two commands are signed as the same bytes.
std::string command_text(const SignedCommand& command) {
  using std::to_string;
  return std::string("control") + '\0' + command.text + '\0' + to_string(command.session) + ' ' +
         to_string(command.counter) + ' ' + to_string(command.utime);
}

bool is_hex(std::string_view text) {
  return std::all_of(text.begin(), text.end(),
                     [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

/// Nothing unless it is a whole number, 0 or more, that fits.
std::optional<int64_t> count_in(const json& envelope, const char* key) {
  const auto member = envelope.find(key);
  if (member == envelope.end() || !member->is_number_unsigned()) return std::nullopt;
  const auto value = member->get<uint64_t>();
  if (value > INT64_MAX) return std::nullopt;
  return static_cast<int64_t>(value);
}

std::optional<std::string> text_in(const json& envelope, const char* key) {
  const auto member = envelope.find(key);
  if (member == envelope.end() || !member->is_string()) return std::nullopt;
  return member->get<std::string>();
}

}  // namespace

SignedCommand sign(const SecretKey& key, std::string text, int64_t session, int64_t counter, int64_t utime) {
  SignedCommand command{std::move(text), session, counter, utime, ""};
  const std::string signed_bytes = command_text(command);
  Tag tag{};
  crypto_auth(tag.data(), reinterpret_cast<const unsigned char*>(signed_bytes.data()), signed_bytes.size(),
              key.bytes().data());
  std::array<char, kTagDigits + 1> hex{};
  command.tag = sodium_bin2hex(hex.data(), hex.size(), tag.data(), tag.size());
  return command;
}

bool verify(const SecretKey& key, const SignedCommand& command) {
  Tag tag{};
  size_t bytes = 0;
  if (command.tag.size() != kTagDigits || !is_hex(command.tag) ||
      sodium_hex2bin(tag.data(), tag.size(), command.tag.data(), command.tag.size(), nullptr, &bytes,
                     nullptr) != 0 ||
      bytes != tag.size())
    return false;
  const std::string signed_bytes = command_text(command);
  return crypto_auth_verify(tag.data(), reinterpret_cast<const unsigned char*>(signed_bytes.data()),
                            signed_bytes.size(), key.bytes().data()) == 0;
}

std::string to_line(const SignedCommand& command) {
  const json envelope = {{"signed", command.text},
                         {"session", command.session},
                         {"counter", command.counter},
                         {"utime", command.utime},
                         {"tag", command.tag}};
  try {
    return envelope.dump();
  } catch (const json::type_error&) {
    throw InputError::at("command", "UTF-8 text", "other bytes");
  }
}

std::string parse_signed_command(std::string_view line, SignedCommand& command) {
  const json envelope = json::parse(line, nullptr, false);
  if (!envelope.is_object()) return "envelope: expected a JSON object, found none";
  const auto text = text_in(envelope, "signed"), tag = text_in(envelope, "tag");
  const auto session = count_in(envelope, "session"), counter = count_in(envelope, "counter"),
             utime = count_in(envelope, "utime");
  if (!text || text->find('\0') != std::string::npos)
    return "signed: expected the request as text, found another value or none";
  if (!session || !counter || !utime || *counter < 1)
    return "session, counter, utime: expected whole numbers, the counter from 1; found others or none";
  if (!tag || tag->size() != kTagDigits || !is_hex(*tag))
    return "tag: expected 64 hex digits (0 to 9, a to f), found another value or none";
  if (envelope.size() != 5)
    return "envelope: expected signed, session, counter, utime and tag, found more members";
  command = {*text, *session, *counter, *utime, *tag};
  return "";
}

std::string name(CommandFault fault) {
  switch (fault) {
    case CommandFault::kNone:
      return "none";
    case CommandFault::kAltered:
      return "altered";
    case CommandFault::kOld:
      return "old";
    case CommandFault::kReplayed:
      return "replayed";
  }
  return "unknown";
}

CommandFault CommandVerifier::judge(const SignedCommand& command, int64_t now) {
  if (!verify(key_, command)) return CommandFault::kAltered;
  // Genuine from here on; but the sender's clock may be wrong, and a session from the future would shut out
  // all that come after it.
  if (command.utime < std::max(start_, now - kMaxAge) || command.utime > now + kMaxAhead ||
      command.session > command.utime)
    return CommandFault::kOld;
  if (std::tie(command.session, command.counter) <= std::tie(session_, counter_))
    return CommandFault::kReplayed;
  session_ = command.session, counter_ = command.counter;
  return CommandFault::kNone;
}

}  // namespace edgepose
