#pragma once
#include <cstdint>
#include <optional>

#include "bus/can_frame.h"

namespace edgepose {

/// Network management (CiA 301, 7.2.8).
enum class NmtCommand : uint8_t {
  kStart = 1,
  kStop = 2,
  kEnterPreOperational = 128,
  kResetNode = 129,
  kResetCommunication = 130,
};

/// As a heartbeat reports it; kBootUp once, after a start or reset.
enum class NmtState : uint8_t { kBootUp = 0, kStopped = 4, kOperational = 5, kPreOperational = 127 };

struct NmtMessage {
  NmtCommand command = NmtCommand::kStart;
  int node = 0;  ///< 0: all
};

/// "operational", ...; "unknown" for a number that is none of these.
const char* name_of(NmtState state);

CanFrame nmt_frame(const NmtMessage& message, int64_t now_ns);
/// None if the frame is no NMT command that the standard knows.
std::optional<NmtMessage> decode_nmt(const CanFrame& frame);

CanFrame heartbeat_frame(int node, NmtState state, int64_t now_ns);
/// None if the frame is no heartbeat, or its state none of the standard's.
std::optional<NmtState> decode_heartbeat(const CanFrame& frame);

/// SYNC without a counter (CiA 301, 7.2.5).
CanFrame sync_frame(int64_t now_ns);
bool is_sync(const CanFrame& frame);

}  // namespace edgepose
