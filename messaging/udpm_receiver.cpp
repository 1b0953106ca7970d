#include "messaging/udpm_receiver.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstring>

#include "common/error.h"
#include "messaging/udpm_socket.h"

namespace edgepose {
namespace {

constexpr size_t kMaxDatagram = 65536;
constexpr int kDatagramsAtOnce = 64;  // between looks at whether the receiver is to end

int64_t steady_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Datagrams that the socket has had no room for since it was opened; 0 before the first.
uint32_t lost_by_kernel(msghdr& header) {
  for (cmsghdr* c = CMSG_FIRSTHDR(&header); c != nullptr; c = CMSG_NXTHDR(&header, c))
    if (c->cmsg_level == SOL_SOCKET && c->cmsg_type == SO_RXQ_OVFL) {
      uint32_t lost = 0;
      std::memcpy(&lost, CMSG_DATA(c), sizeof(lost));
      return lost;
    }
  return 0;
}

}  // namespace

UdpmReceiver::UdpmReceiver(const UdpmAddress& address, Handler handler, const AssemblyOptions& options)
    : handler_(std::move(handler)), assembly_(options) {
  socket_ = open_udpm_socket(address);
  receive_buffer_bytes_ = receive_buffer_of(socket_);
  wake_ = eventfd(0, EFD_CLOEXEC);
  if (wake_ < 0) {
    close(socket_);
    throw InputError::at("udpm receiver", "an event descriptor", std::strerror(errno));
  }
  thread_ = std::thread([this] { run(); });
}

UdpmReceiver::~UdpmReceiver() {
  eventfd_write(wake_, 1);
  thread_.join();
  close(wake_);
  close(socket_);
}

ReceiveCounters UdpmReceiver::counters() const {
  const std::scoped_lock lock(mutex_);
  return counters_;
}

void UdpmReceiver::run() {
  std::vector<std::byte> buffer(kMaxDatagram);
  std::array<pollfd, 2> waits = {{{socket_, POLLIN, 0}, {wake_, POLLIN, 0}}};
  while (true) {
    if (poll(waits.data(), waits.size(), -1) < 0 && errno != EINTR) {
      failed_ = true;
      return;
    }
    if (waits[1].revents != 0) return;
    if (waits[0].revents != 0) drain(buffer);
  }
}

void UdpmReceiver::drain(std::span<std::byte> buffer) {
  for (int i = 0; i < kDatagramsAtOnce; ++i) {
    sockaddr_in from{};
    iovec into{buffer.data(), buffer.size()};
    alignas(cmsghdr) std::array<std::byte, 64> control;
    msghdr header{};
    header.msg_name = &from;
    header.msg_namelen = sizeof(from);
    header.msg_iov = &into;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const ssize_t size = recvmsg(socket_, &header, 0);
    if (size < 0) return;
    {
      const std::scoped_lock lock(mutex_);
      ++counters_.datagrams;
      counters_.bytes += static_cast<uint64_t>(size);
      if (const uint32_t lost = lost_by_kernel(header); lost > 0) counters_.lost_by_kernel = lost;
    }
    const SenderKey sender = uint64_t{ntohl(from.sin_addr.s_addr)} << 16 | ntohs(from.sin_port);
    take(sender, buffer.first(static_cast<size_t>(size)));
  }
}

void UdpmReceiver::take(SenderKey sender, std::span<const std::byte> datagram) {
  UdpmPacket packet;
  const UdpmFault fault = parse_udpm(datagram, packet);
  std::optional<ReceivedMessage> message;
  if (fault == UdpmFault::kNone) message = assembly_.add(sender, packet, steady_us());
  {
    const std::scoped_lock lock(mutex_);
    counters_.malformed += fault != UdpmFault::kNone;
    counters_.assembly = assembly_.counters();
  }
  if (message) handler_(std::move(*message));
}

}  // namespace edgepose
