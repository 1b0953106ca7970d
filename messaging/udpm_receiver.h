#pragma once
#include <atomic>
#include <functional>
#include <mutex>
#include <thread>

#include "messaging/udpm_address.h"
#include "messaging/udpm_assembly.h"

namespace edgepose {

/// What came in since the start. Every datagram is counted once, by what became of it.
struct ReceiveCounters {
  uint64_t datagrams = 0, bytes = 0;
  uint64_t malformed = 0;       ///< no datagrams of LCM's
  uint64_t lost_by_kernel = 0;  ///< datagrams that the socket's buffer had no room for
  AssemblyCounters assembly;
};

/// Receives LCM messages from UDP multicast, on a plain POSIX socket and a thread of its own: liblcm's
/// receiver can be crashed from the network (docs/lcm.md). What arrives is not trusted: bounded, and counted
/// if dropped.
class UdpmReceiver {
 public:
  /// Called on the receiver's thread for each whole message; must be quick, and what it throws ends the
  /// program.
  using Handler = std::function<void(ReceivedMessage&&)>;

  /// Joins the group and starts to receive. Throws InputError if the group cannot be joined (no multicast
  /// route).
  UdpmReceiver(const UdpmAddress& address, Handler handler, const AssemblyOptions& options = {});
  UdpmReceiver(const UdpmReceiver&) = delete;
  UdpmReceiver& operator=(const UdpmReceiver&) = delete;
  ~UdpmReceiver();  ///< leaves the group; no handler runs afterwards

  /// [bytes] that the kernel granted; less than was asked if net.core.rmem_max forbids it.
  int receive_buffer_bytes() const { return receive_buffer_bytes_; }
  ReceiveCounters counters() const;  ///< from any thread
  /// The system has refused to go on; nothing is received any more.
  bool failed() const { return failed_; }

 private:
  void run();
  void drain(std::span<std::byte> buffer);
  void take(SenderKey sender, std::span<const std::byte> datagram);

  const Handler handler_;
  int socket_ = -1, wake_ = -1;
  int receive_buffer_bytes_ = 0;
  UdpmAssembly assembly_;
  mutable std::mutex mutex_;
  ReceiveCounters counters_;  // guarded by mutex_
  std::atomic<bool> failed_ = false;
  std::thread thread_;
};

}  // namespace edgepose
