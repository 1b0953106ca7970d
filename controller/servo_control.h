#pragma once
#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "controller/control_loop.h"
#include "daemon/json_rpc.h"
#include "daemon/line_server.h"

namespace edgepose {

/// What does not change while the controller runs, for `status`.
struct ControllerFacts {
  std::string version, bus, lcm_url, model;
  bool is_taught = false, is_signed = false;
};

/// Answers commands (docs/controller.md): arm, go, stop, reset, homed, status, shutdown. handle() is called
/// on the line server's thread; finish_requests() on another.
class ServoControl {
 public:
  using Later = std::function<void(LineServer::ClientId, std::string)>;

  ServoControl(ControlLoop& loop, PoseInbox& poses, ControllerFacts facts, std::function<void()> shutdown);

  /// As LineServer::Handler; `later` takes the answers to what the loop has to do first.
  std::optional<std::string> handle(LineServer::ClientId client, const std::string& line, const Later& later);
  /// Hands on the loop's answer, if there is one. To be called every few ms.
  void finish_requests();
  /// The hole that the arm was last sent to; empty before that.
  std::string target() const;

 private:
  struct Waiting {
    RpcRequest request;
    LineServer::ClientId client = 0;
    Later later;
    std::string target;  ///< of go
    ServoGoal hole;
  };
  std::optional<std::string> run(const RpcRequest& request, LineServer::ClientId client, const Later& later);
  void post(ArmRequest what, const RpcRequest& request, LineServer::ClientId client, const Later& later,
            const std::string& target = "");
  std::string status() const;

  ControlLoop& loop_;
  PoseInbox& poses_;
  const ControllerFacts facts_;
  const std::function<void()> shutdown_;
  mutable std::mutex mutex_;
  std::optional<Waiting> waiting_;  // guarded by mutex_
  std::string target_;              // guarded by mutex_
};

}  // namespace edgepose
