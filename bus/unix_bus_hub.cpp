#include "bus/unix_bus_hub.h"

#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>

#include "bus/steady_clock.h"
#include "bus/unix_address.h"
#include "common/error.h"

namespace edgepose {
namespace {

/// Frames taken from a member before the others have their turn.
constexpr int kBatch = 64;
constexpr size_t kBurst = 32;         // two cycles of six drives
constexpr size_t kSenderFrames = 32;  // of one sender that wait for the wire, two cycles as well

int packet_socket() { return socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0); }

bool somebody_listens(const UnixAddress& address) {
  const int probe = packet_socket();
  const bool joined = probe >= 0 && connect(probe, address.get(), sizeof(address.value)) == 0;
  if (probe >= 0) close(probe);
  return joined;
}

}  // namespace

UnixBusHub::UnixBusHub(const std::filesystem::path& path, const UnixBusHubOptions& options)
    : options_(options), path_(path) {
  if (options.rate > 0) wire_.emplace(options.rate, kBurst, kSenderFrames);
  const UnixAddress address = unix_address(path);
  std::error_code ignored;
  if (std::filesystem::is_socket(path, ignored)) {
    if (somebody_listens(address))
      throw InputError::at("bus unix:" + path.string(), "a place for a bus", "another one there");
    unlink(path.c_str());
  }
  listener_ = packet_socket();
  const bool made = listener_ >= 0 && bind(listener_, address.get(), sizeof(address.value)) == 0;
  if (made && chmod(path.c_str(), 0660) == 0 && listen(listener_, 16) == 0) return;
  const int cause = errno;
  if (listener_ >= 0) close(listener_);
  if (made) unlink(path.c_str());
  throw InputError::at("bus unix:" + path.string(), "a place for a bus", std::strerror(cause));
}

UnixBusHub::~UnixBusHub() {
  for (const auto& member : members_) close(member->socket);
  close(listener_);
  unlink(path_.c_str());
}

void UnixBusHub::serve(int64_t deadline_ns) {
  watched_.assign(1, {.fd = listener_, .events = POLLIN, .revents = 0});
  for (const auto& member : members_) {
    const int events = POLLIN | (member->waiting.empty() ? 0 : POLLOUT);
    watched_.push_back({.fd = member->socket, .events = static_cast<short>(events), .revents = 0});
  }
  const int64_t now = steady_ns();
  if (wire_ && !wire_->empty()) deadline_ns = std::min(deadline_ns, now + wire_->ns_a_frame());
  const int64_t left = std::max<int64_t>(0, deadline_ns - now);
  const timespec timeout{.tv_sec = left / 1'000'000'000, .tv_nsec = left % 1'000'000'000};
  const int ready = ppoll(watched_.data(), watched_.size(), &timeout, nullptr);
  if (ready < 0 || (ready == 0 && !wire_)) return;
  for (size_t i = 1; i < watched_.size(); ++i)
    if (watched_[i].revents & ~POLLOUT) read_from(*members_[i - 1]);
  release(steady_ns());
  for (const auto& member : members_) write_to(*member);
  remove_gone();
  if (watched_[0].revents & POLLIN) accept_members();
}

void UnixBusHub::accept_members() {
  for (;;) {
    const int joined = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (joined < 0) return;
    if (members_.size() < options_.max_members) {
      members_.push_back(std::make_unique<Member>(Member{.socket = joined, .waiting = {}}));
    } else {
      close(joined);
      ++counters_.turned_away;
    }
  }
}

void UnixBusHub::read_from(Member& member) {
  std::array<uint8_t, 2 * kFrameRecordBytes> packet;
  for (int i = 0; i < kBatch && !member.gone; ++i) {
    const ssize_t got = recv(member.socket, packet.data(), packet.size(), MSG_DONTWAIT);
    if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (got <= 0) {
      member.gone = true;
    } else if (got != static_cast<ssize_t>(kFrameRecordBytes)) {
      member.gone = true;
      ++counters_.wrong_cut_off;
    } else {
      FrameRecord record;
      std::copy_n(packet.begin(), kFrameRecordBytes, record.begin());
      take(member.socket, record);
    }
  }
}

void UnixBusHub::take(int from, const FrameRecord& record) {
  if (!wire_) return pass_on(from, record);
  const uint32_t id = uint32_t{record[2]} << 8 | record[3];  // error frames come first
  if (!wire_->put(id, from, record)) ++counters_.lost;
}

void UnixBusHub::release(int64_t now_ns) {
  if (!wire_) return;
  while (const auto next = wire_->take(now_ns)) pass_on(next->from, next->record);
}

void UnixBusHub::pass_on(int from, const FrameRecord& record) {
  ++counters_.passed_on;
  for (const auto& member : members_) {
    if (member->socket == from || member->gone) continue;
    if (member->waiting.size() >= options_.max_waiting) write_to(*member);
    if (member->waiting.size() >= options_.max_waiting) {
      member->gone = true;
      ++counters_.slow_cut_off;
    } else {
      member->waiting.push_back(record);
    }
  }
}

void UnixBusHub::write_to(Member& member) {
  while (!member.gone && !member.waiting.empty()) {
    const FrameRecord& record = member.waiting.front();
    const ssize_t sent = send(member.socket, record.data(), record.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent == static_cast<ssize_t>(record.size())) {
      member.waiting.pop_front();
      continue;
    }
    member.gone = errno != EAGAIN && errno != EINTR && errno != ENOBUFS;
    return;
  }
}

void UnixBusHub::remove_gone() {
  std::erase_if(members_, [](const auto& member) {
    if (member->gone) close(member->socket);
    return member->gone;
  });
}

}  // namespace edgepose
