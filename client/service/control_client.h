#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/error.h"
#include "messaging/authentication.h"

namespace edgepose {

/// Where the daemon takes commands (docs/control.md).
struct ControlAddress {
  std::filesystem::path socket;       ///< Unix socket, unless there is a port
  int port = 0;                       ///< TCP, of the loopback
  std::string program = "edgeposed";  ///< who is expected to listen there, and what to do if nobody does
  std::string advice =
      "start it: systemctl start edgeposed, or edgeposed --config FILE; --socket, EDGEPOSE_SOCKET or --tcp "
      "name another place";

  std::string text() const;  ///< "/run/edgepose/control.sock" or "127.0.0.1:7668"
};

/// The daemon's own answer that it cannot do what was asked. what() is its one line.
class ControlError : public InputError {
 public:
  ControlError(int code, const std::string& message) : InputError(message), code_(code) {}
  int code() const { return code_; }  ///< as docs/control.md lists them

 private:
  int code_;
};

/// One connection to the daemon. Nothing that it answers is trusted. Not thread-safe.
class ControlClient {
 public:
  static constexpr size_t kMaxRequestBytes = size_t{64} << 10;
  static constexpr size_t kMaxAnswerBytes = size_t{16} << 20;

  /// Connects. With a key, commands that change something are signed. Throws InputError that says how to
  /// start the daemon if nobody listens.
  ControlClient(const ControlAddress& address, const std::optional<SecretKey>& key);
  ControlClient(const ControlClient&) = delete;
  ControlClient& operator=(const ControlClient&) = delete;
  ~ControlClient();

  /// Called about ten times a second while waiting, with the seconds since the request.
  using Waiting = std::function<void(double)>;

  /// Sends one request and returns its `result`. `timeout`: [s] until the whole answer has come. Throws
  /// ControlError for the daemon's refusal; InputError if the request is too long or no UTF-8, the connection
  /// ends, time is up, or the answer is malformed, too long or another's.
  nlohmann::json call(const std::string& method, const nlohmann::json& params, double timeout,
                      const Waiting& waiting = {});

 private:
  std::string envelope(const std::string& method, std::string request);
  void send(const std::string& line, double timeout);
  std::string receive(double timeout, const Waiting& waiting);

  ControlAddress address_;
  std::optional<SecretKey> key_;
  int socket_ = -1;
  int64_t session_, counter_ = 0, id_ = 0;
  std::string rest_;  // received after the last answer
};

}  // namespace edgepose
