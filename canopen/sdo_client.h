#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "bus/can_bus.h"
#include "canopen/sdo.h"

namespace edgepose {

/// Reads and writes objects of one node, one transfer at a time, each with its deadline. Waits for nothing:
/// who owns it passes in the node's answers and the time.
class SdoClient {
 public:
  enum class State : uint8_t { kIdle, kBusy, kDone, kAborted, kTimedOut };

  SdoClient(CanBus& bus, int node);

  /// Both end a transfer that is under way. `timeout_ns` is for the whole of it.
  void upload(ObjectId id, int64_t now_ns, int64_t timeout_ns);
  void download(ObjectId id, std::span<const uint8_t> data, int64_t now_ns, int64_t timeout_ns);

  /// A frame with the node's answer (0x580 + node).
  void take(const CanFrame& frame, int64_t now_ns);
  /// Looks at the deadline; sends what the bus had no room for (a request does not grow stale as a set-point
  /// does).
  void tick(int64_t now_ns);

  State state() const { return state_; }
  ObjectId object() const { return id_; }
  std::span<const uint8_t> data() const { return data_; }  ///< of an upload that is done
  SdoAbort abort_reason() const { return reason_; }        ///< if kAborted
  bool aborted_by_node() const { return by_node_; }        ///< else by this client
  /// Answers while nothing was asked for. Two nodes of one number answer twice.
  uint32_t unasked() const { return unasked_; }

 private:
  void begin(ObjectId id, int64_t now_ns, int64_t timeout_ns, bool upload);
  void send(const sdo::Bytes& bytes, int64_t now_ns);
  void fail(SdoAbort reason, int64_t now_ns);
  void take_upload(const sdo::Bytes& bytes, int64_t now_ns);
  void take_download(const sdo::Bytes& bytes, int64_t now_ns);
  void send_segment(int64_t now_ns);

  CanBus& bus_;
  const int node_;
  State state_ = State::kIdle;
  ObjectId id_;
  bool upload_ = false, segments_ = false, toggle_ = false, by_node_ = false, unsent_ = false;
  SdoAbort reason_ = SdoAbort::kNone;
  std::vector<uint8_t> data_;
  size_t at_ = 0;           ///< of a download: bytes that were sent
  uint32_t announced_ = 0;  ///< of an upload
  CanFrame request_;
  int64_t deadline_ns_ = 0;
  uint32_t unasked_ = 0;
};

}  // namespace edgepose
