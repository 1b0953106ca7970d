#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "messaging/authentication.h"

namespace edgepose {

/// A command to the daemon in its envelope (docs/control.md, "Signed commands").
struct SignedCommand {
  std::string text;     ///< the request, UTF-8
  int64_t session = 0;  ///< [us] since 1970, UTC: when the client started
  int64_t counter = 0;  ///< of the session's signed commands, from 1
  int64_t utime = 0;    ///< [us] since 1970, UTC: when it was signed
  std::string tag;      ///< 64 hex digits
};

/// Puts the tag on it.
SignedCommand sign(const SecretKey& key, std::string text, int64_t session, int64_t counter, int64_t utime);

/// Whether the tag is this command's under `key`. Says nothing of its age, nor whether it has come before.
bool verify(const SecretKey& key, const SignedCommand& command);

/// The envelope as one line, without its end. Throws InputError if the text is no UTF-8.
std::string to_line(const SignedCommand& command);

/// Reads an envelope, whoever wrote it. Returns why it is none, in one line, or an empty string; never
/// throws. `command` is valid only then; nothing of it is verified.
std::string parse_signed_command(std::string_view line, SignedCommand& command);

/// What a receiver thinks of a signed command.
enum class CommandFault {
  kNone,
  kAltered,   ///< the tag is not this command's: changed, or another key's
  kOld,       ///< signed too long ago, before the receiver's start, or in the future
  kReplayed,  ///< genuine, but not newer than one that has come before
};
std::string name(CommandFault fault);

/// Judges signed commands. A genuine one counts as come: the same one is replayed from then on. Not
/// thread-safe.
class CommandVerifier {
 public:
  static constexpr int64_t kMaxAge = 30'000'000;   ///< [us]
  static constexpr int64_t kMaxAhead = 1'000'000;  ///< [us] that the clock may have been set back in between

  /// `start`: [us] since 1970, UTC. What was signed before is refused: which of it has come is not known.
  CommandVerifier(const SecretKey& key, int64_t start) : key_(key), start_(start) {}

  /// `now`: [us] since 1970, UTC.
  CommandFault judge(const SignedCommand& command, int64_t now);

 private:
  SecretKey key_;
  int64_t start_;
  int64_t session_ = 0, counter_ = 0;  // of the newest genuine command
};

}  // namespace edgepose
