#pragma once
#include <cstddef>
#include <cstdint>
#include <list>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "messaging/udpm_packet.h"

namespace edgepose {

/// A whole message as it came, nothing of it checked.
struct ReceivedMessage {
  std::string channel;
  std::unique_ptr<std::byte[]> bytes;
  size_t size = 0;
  std::span<const std::byte> data() const { return {bytes.get(), size}; }
};

/// Who sent a datagram: address and port, in one number.
using SenderKey = uint64_t;

/// How much unfinished work foreign fragments may cause.
struct AssemblyOptions {
  size_t max_message_bytes = size_t{64} << 20;  ///< [bytes] longer messages are refused
  size_t max_bytes = size_t{192} << 20;         ///< [bytes] of all unfinished messages together
  size_t max_per_sender = 3;                    ///< unfinished messages of one sender; the oldest goes first
  size_t max_unfinished = 64;                   ///< of all senders
  int64_t max_age_us = 1'000'000;               ///< [us] since the last fragment; older ones are given up

  /// Empty if sound, else one line that names the bad field.
  std::string check() const;
};

/// What became of datagrams and messages, since the start.
struct AssemblyCounters {
  uint64_t messages = 0;    ///< delivered
  uint64_t duplicates = 0;  ///< fragments that had come before
  uint64_t refused = 0;     ///< fragments of messages that are too long, or that contradict the others
  uint64_t given_up = 0;    ///< messages that stayed incomplete
};

/// Puts fragments together, in any order. A message is delivered only if its fragments fill it without a gap
/// or an overlap. Memory stays within the options whatever comes. Not thread-safe.
class UdpmAssembly {
 public:
  explicit UdpmAssembly(const AssemblyOptions& options = {}) : options_(options) {}

  /// `packet` as parse_udpm() found it sound; `now_us` on any clock that never goes back.
  std::optional<ReceivedMessage> add(SenderKey sender, const UdpmPacket& packet, int64_t now_us);

  const AssemblyCounters& counters() const { return counters_; }
  size_t unfinished() const { return unfinished_.size(); }
  size_t bytes() const { return bytes_; }

 private:
  struct Piece {
    uint32_t offset = 0, size = 0;  // size 0: has not come
  };
  struct Unfinished {
    SenderKey sender;
    uint32_t sequence;
    int64_t last_us;
    ReceivedMessage message;
    std::vector<Piece> pieces;
    size_t missing;
  };
  using Entry = std::list<Unfinished>::iterator;

  Entry find(SenderKey sender, uint32_t sequence);
  Entry start(SenderKey sender, const UdpmPacket& packet);
  void give_up(Entry entry);
  void make_room(SenderKey sender, size_t bytes, int64_t now_us);

  AssemblyOptions options_;
  AssemblyCounters counters_;
  std::list<Unfinished> unfinished_;  // the oldest first
  size_t bytes_ = 0;
};

}  // namespace edgepose
