#include "canopen/nmt.h"

#include "canopen/cob_id.h"

namespace edgepose {

const char* name_of(NmtState state) {
  switch (state) {
    case NmtState::kBootUp:
      return "boot-up";
    case NmtState::kStopped:
      return "stopped";
    case NmtState::kOperational:
      return "operational";
    case NmtState::kPreOperational:
      return "pre-operational";
  }
  return "unknown";
}

CanFrame nmt_frame(const NmtMessage& message, int64_t now_ns) {
  CanFrame frame{.id = cob_id::kNmt, .size = 2, .data = {}, .time_ns = now_ns};
  frame.data[0] = static_cast<uint8_t>(message.command);
  frame.data[1] = static_cast<uint8_t>(message.node);
  return frame;
}

std::optional<NmtMessage> decode_nmt(const CanFrame& frame) {
  if (frame.id != cob_id::kNmt || frame.size != 2 || frame.data[1] > cob_id::kMaxNode) return std::nullopt;
  switch (const auto command = static_cast<NmtCommand>(frame.data[0])) {
    case NmtCommand::kStart:
    case NmtCommand::kStop:
    case NmtCommand::kEnterPreOperational:
    case NmtCommand::kResetNode:
    case NmtCommand::kResetCommunication:
      return NmtMessage{.command = command, .node = frame.data[1]};
  }
  return std::nullopt;
}

CanFrame heartbeat_frame(int node, NmtState state, int64_t now_ns) {
  CanFrame frame{
      .id = static_cast<uint16_t>(cob_id::kHeartbeat + node), .size = 1, .data = {}, .time_ns = now_ns};
  frame.data[0] = static_cast<uint8_t>(state);
  return frame;
}

std::optional<NmtState> decode_heartbeat(const CanFrame& frame) {
  if (cob_id::function_of(frame.id) != cob_id::kHeartbeat || frame.size != 1) return std::nullopt;
  // The top bit is node guarding's toggle, reserved in heartbeats.
  switch (const auto state = static_cast<NmtState>(frame.data[0])) {
    case NmtState::kBootUp:
    case NmtState::kStopped:
    case NmtState::kOperational:
    case NmtState::kPreOperational:
      return state;
  }
  return std::nullopt;
}

CanFrame sync_frame(int64_t now_ns) {
  return {.id = cob_id::kSync, .size = 0, .data = {}, .time_ns = now_ns};
}

bool is_sync(const CanFrame& frame) { return frame.id == cob_id::kSync && frame.size == 0; }

}  // namespace edgepose
