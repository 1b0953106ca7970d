#pragma once
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "daemon/json_rpc.h"
#include "daemon/line_server.h"
#include "messaging/signed_command.h"
#include "server/registrar.h"
#include "server/statistics.h"
#include "server/worker.h"

namespace edgepose {

/// What does not change while the daemon runs, for `status`.
struct ServiceFacts {
  std::string version, lcm_url, config_file;
  int receive_buffer_bytes = 0;
  int64_t start_utime = 0;  ///< [us] since 1970, UTC
};

/// The parts of the daemon that commands reach.
struct ServiceParts {
  Registry& registry;
  Registrar& registrar;
  Worker& worker;
  Statistics& statistics;
  const LiveOptions& options;
  std::function<void()> shutdown;
  std::optional<SecretKey> key;
};

/// Answers commands (docs/control.md). Used on the line server's thread only.
class Control {
 public:
  Control(ServiceParts parts, ServiceFacts facts);

  /// As LineServer::Handler. `later` takes the answers that are given from other threads.
  std::optional<std::string> handle(LineServer::ClientId client, const std::string& line,
                                    const std::function<void(LineServer::ClientId, std::string)>& later);

 private:
  /// An answer at once (a JSON text), or nothing: it comes later.
  using Reply = std::optional<std::string>;
  struct Call {
    const RpcRequest& request;
    std::function<void(std::string)> finish;  ///< takes the whole answer's line
  };
  using Method = Reply (Control::*)(const Call&);

  RpcRequest open(const std::string& line);
  Reply list_models(const Call& call);
  Reply get_model(const Call& call);
  Reply register_model(const Call& call);
  Reply unregister_model(const Call& call);
  Reply activate_model(const Call& call);
  Reply status(const Call& call);
  Reply stats(const Call& call);
  Reply detect(const Call& call);
  Reply get_config(const Call& call);
  Reply shutdown(const Call& call);
  [[noreturn]] void no_model(const std::string& name) const;

  static const std::map<std::string, Method>& methods();

  ServiceParts parts_;
  const ServiceFacts facts_;
  std::optional<CommandVerifier> verifier_;
};

}  // namespace edgepose
