#include "canopen/drive_set_up.h"

#include <cstdio>

#include "canopen/cob_id.h"

namespace edgepose {
namespace {

int64_t nanoseconds(double seconds) { return static_cast<int64_t>(seconds * 1e9); }

std::string hex_number(int64_t value) {
  char text[16];
  std::snprintf(text, sizeof(text), "0x%x", static_cast<uint32_t>(value));
  return text;
}

}  // namespace

DriveSetUp::DriveSetUp(CanBus& bus, const MasterOptions& options, int axis)
    : bus_(bus),
      options_(options),
      node_(options.nodes[static_cast<size_t>(axis)]),
      steps_(set_up_steps(options, axis)),
      client_(bus, node_) {}

void DriveSetUp::begin(int64_t now_ns) {
  state_ = State::kRunning;
  at_ = 0;
  boot_ups_ = 0;
  duplicate_ = false;
  unasked_before_ = client_.unasked();
  error_.clear();
  enter_step(now_ns);
}

void DriveSetUp::next_step(int64_t now_ns) {
  if (++at_ == steps_.size())
    state_ = State::kDone;
  else
    enter_step(now_ns);
}

void DriveSetUp::enter_step(int64_t now_ns) {
  began_ns_ = now_ns;
  unsent_ = false;
  const int64_t timeout = nanoseconds(options_.sdo_timeout);
  switch (step().kind) {
    case SetUpStep::Kind::kBootUp:
      send_nmt(NmtCommand::kResetCommunication, now_ns);
      break;
    case SetUpStep::Kind::kSettle:
      break;
    case SetUpStep::Kind::kExpect:
      client_.upload(step().id, now_ns, timeout);
      break;
    case SetUpStep::Kind::kWrite: {
      std::vector<uint8_t> bytes;
      append_number(step().type, step().value, bytes);
      client_.download(step().id, bytes, now_ns, timeout);
      break;
    }
    case SetUpStep::Kind::kStart:
      send_nmt(NmtCommand::kStart, now_ns);
      break;
  }
}

void DriveSetUp::send_nmt(NmtCommand command, int64_t now_ns) {
  unsent_ = bus_.send(nmt_frame({.command = command, .node = node_}, now_ns)) != SendResult::kSent;
}

void DriveSetUp::take(const CanFrame& frame, int64_t now_ns) {
  if (state_ == State::kDone && decode_heartbeat(frame) == NmtState::kBootUp)
    return fail_duplicate("it booted again", now_ns);
  if (state_ != State::kRunning) return;
  if (frame.id == cob_id::kHeartbeat + node_) {
    const auto state = decode_heartbeat(frame);
    if (!state) return;
    last_heartbeat_ = *state;
    if (*state == NmtState::kBootUp && ++boot_ups_ > 1)
      return fail_duplicate(
          step().kind == SetUpStep::Kind::kSettle ? "two of them booted" : "it booted again", now_ns);
    if (step().kind == SetUpStep::Kind::kBootUp && boot_ups_ > 0) return next_step(now_ns);
    if (step().kind == SetUpStep::Kind::kStart && *state == NmtState::kOperational) return next_step(now_ns);
    return;
  }
  client_.take(frame, now_ns);
  if (client_.unasked() != unasked_before_) return fail_duplicate("two answers to one question", now_ns);
  take_answer(now_ns);
}

void DriveSetUp::take_answer(int64_t now_ns) {
  const bool reads = step().kind == SetUpStep::Kind::kExpect;
  if (!reads && step().kind != SetUpStep::Kind::kWrite) return;
  const std::string what = std::string(step().name) + " (" + text_of(step().id) + ")";
  const std::string value = hex_number(step().value);
  const std::string wanted = reads ? what + " to be " + value : what + " to take " + value;
  switch (client_.state()) {
    case SdoClient::State::kTimedOut:
      fail(wanted, "no answer", now_ns);
      break;
    case SdoClient::State::kAborted: {
      const auto reason = static_cast<uint32_t>(client_.abort_reason());
      const char* who = client_.aborted_by_node() ? "abort " : "an answer against the protocol, abort ";
      fail(wanted, who + hex_number(reason) + " (" + text_of(client_.abort_reason()) + ")", now_ns);
      break;
    }
    case SdoClient::State::kDone: {
      if (!reads) return next_step(now_ns);
      const auto data = client_.data();
      if (data.size() != bytes_of(step().type))
        return fail(wanted, std::to_string(data.size()) + " bytes", now_ns);
      const auto found = static_cast<uint32_t>(number_from(step().type, data));
      if (((found ^ static_cast<uint32_t>(step().value)) & step().mask) != 0)
        return fail(wanted, hex_number(found), now_ns);
      next_step(now_ns);
      break;
    }
    default:
      break;
  }
}

void DriveSetUp::tick(int64_t now_ns) {
  if (state_ != State::kRunning) return;
  const int64_t waited = now_ns - began_ns_;
  switch (step().kind) {
    case SetUpStep::Kind::kBootUp:
      if (waited >= nanoseconds(options_.boot_timeout)) return fail("boot-up after a reset", "none", now_ns);
      if (unsent_) send_nmt(NmtCommand::kResetCommunication, now_ns);
      break;
    case SetUpStep::Kind::kSettle:
      if (waited >= nanoseconds(options_.settle)) next_step(now_ns);
      break;
    case SetUpStep::Kind::kStart:
      if (waited >= nanoseconds(options_.start_timeout))
        return fail("a heartbeat that says operational", std::string("state ") + name_of(last_heartbeat_),
                    now_ns);
      if (unsent_) send_nmt(NmtCommand::kStart, now_ns);
      break;
    default:
      client_.tick(now_ns);
      take_answer(now_ns);
  }
}

void DriveSetUp::fail(const std::string& expected, const std::string& found, int64_t now_ns) {
  state_ = State::kFailed;
  error_ = "node " + std::to_string(node_) + ": expected " + expected + ", found " + found + " after " +
           std::to_string((now_ns - began_ns_) / 1'000'000) + " ms";
}

void DriveSetUp::fail_duplicate(const std::string& found, int64_t now_ns) {
  duplicate_ = true;
  fail("one drive of this number", found, now_ns);
}

}  // namespace edgepose
