#include "messaging/udpm_assembly.h"

#include <algorithm>
#include <cstring>

namespace edgepose {
namespace {

ReceivedMessage allocate(std::string_view channel, size_t size) {
  // Not touched here: a sender that announces much and sends little costs address space, not memory.
  return {std::string(channel), std::make_unique_for_overwrite<std::byte[]>(size), size};
}

void copy(const UdpmPacket& packet, ReceivedMessage& message) {
  if (!packet.payload.empty())
    std::memcpy(message.bytes.get() + packet.offset, packet.payload.data(), packet.payload.size());
}

}  // namespace

std::string AssemblyOptions::check() const {
  if (max_message_bytes < 1 || max_message_bytes > max_bytes)
    return "max_message_bytes: expected 1 to max_bytes";
  if (max_per_sender < 1) return "max_per_sender: expected 1 or more";
  if (max_unfinished < max_per_sender) return "max_unfinished: expected max_per_sender or more";
  if (max_age_us < 1) return "max_age_us: expected 1 us or more";
  return "";
}

std::optional<ReceivedMessage> UdpmAssembly::add(SenderKey sender, const UdpmPacket& packet, int64_t now_us) {
  if (packet.message_size > options_.max_message_bytes || packet.fragments > packet.message_size + 1ull) {
    ++counters_.refused;
    return std::nullopt;
  }
  if (packet.fragments == 1 && packet.payload.size() == packet.message_size) {
    ReceivedMessage message = allocate(packet.channel, packet.message_size);
    copy(packet, message);
    ++counters_.messages;
    return message;
  }

  Entry entry = find(sender, packet.sequence);
  if (entry == unfinished_.end()) {
    make_room(sender, packet.message_size, now_us);
    entry = start(sender, packet);
  }
  if (entry->message.size != packet.message_size || entry->pieces.size() != packet.fragments) {
    ++counters_.refused;
    return std::nullopt;
  }
  Piece& piece = entry->pieces[packet.fragment];
  if (piece.size != 0) {
    ++counters_.duplicates;
    return std::nullopt;
  }
  piece = {packet.offset, static_cast<uint32_t>(packet.payload.size())};
  copy(packet, entry->message);
  if (packet.fragment == 0) entry->message.channel = packet.channel;
  entry->last_us = now_us;
  if (--entry->missing > 0) return std::nullopt;

  uint64_t end = 0;
  const bool gapless = std::all_of(entry->pieces.begin(), entry->pieces.end(), [&](const Piece& p) {
    const bool follows = p.offset == end;
    end += p.size;
    return follows;
  });
  if (!gapless || end != entry->message.size) {
    ++counters_.refused;
    give_up(entry);
    return std::nullopt;
  }
  ReceivedMessage message = std::move(entry->message);
  bytes_ -= message.size;
  unfinished_.erase(entry);
  ++counters_.messages;
  return message;
}

UdpmAssembly::Entry UdpmAssembly::find(SenderKey sender, uint32_t sequence) {
  return std::find_if(unfinished_.begin(), unfinished_.end(),
                      [&](const Unfinished& u) { return u.sender == sender && u.sequence == sequence; });
}

UdpmAssembly::Entry UdpmAssembly::start(SenderKey sender, const UdpmPacket& packet) {
  bytes_ += packet.message_size;
  return unfinished_.insert(unfinished_.end(), {sender, packet.sequence, 0, allocate("", packet.message_size),
                                                std::vector<Piece>(packet.fragments), packet.fragments});
}

void UdpmAssembly::give_up(Entry entry) {
  bytes_ -= entry->message.size;
  unfinished_.erase(entry);
  ++counters_.given_up;
}

/// Each sender pays for its own first: one that leaves many messages open does not cost others theirs.
void UdpmAssembly::make_room(SenderKey sender, size_t bytes, int64_t now_us) {
  for (Entry u = unfinished_.begin(); u != unfinished_.end();) {
    const Entry next = std::next(u);
    if (now_us - u->last_us > options_.max_age_us) give_up(u);
    u = next;
  }
  const auto of_sender = [&](const Unfinished& u) { return u.sender == sender; };
  while (static_cast<size_t>(std::count_if(unfinished_.begin(), unfinished_.end(), of_sender)) >=
         options_.max_per_sender)
    give_up(std::find_if(unfinished_.begin(), unfinished_.end(), of_sender));
  while (!unfinished_.empty() &&
         (unfinished_.size() >= options_.max_unfinished || bytes_ + bytes > options_.max_bytes)) {
    const Entry own = std::find_if(unfinished_.begin(), unfinished_.end(), of_sender);
    give_up(own != unfinished_.end() ? own : unfinished_.begin());
  }
}

}  // namespace edgepose
