#include "server/control.h"

#include <set>

#include "common/error.h"
#include "common/nearest_word.h"
#include "daemon/clock.h"
#include "daemon/json_rpc.h"
#include "daemon/log.h"

namespace edgepose {
namespace {

/// What changes something must be signed, where there is a key.
const std::set<std::string> kSignedMethods = {"models.register", "models.unregister", "models.activate",
                                              "shutdown"};

}  // namespace

Control::Control(ServiceParts parts, ServiceFacts facts)
    : parts_(std::move(parts)), facts_(std::move(facts)) {
  if (parts_.key) verifier_.emplace(*parts_.key, facts_.start_utime);
}

const std::map<std::string, Control::Method>& Control::methods() {
  static const std::map<std::string, Method> all = {{"models.list", &Control::list_models},
                                                    {"models.get", &Control::get_model},
                                                    {"models.register", &Control::register_model},
                                                    {"models.unregister", &Control::unregister_model},
                                                    {"models.activate", &Control::activate_model},
                                                    {"status", &Control::status},
                                                    {"stats", &Control::stats},
                                                    {"detect", &Control::detect},
                                                    {"config.get", &Control::get_config},
                                                    {"shutdown", &Control::shutdown}};
  return all;
}

std::optional<std::string> Control::handle(
    LineServer::ClientId client, const std::string& line,
    const std::function<void(LineServer::ClientId, std::string)>& later) {
  RpcRequest request;
  const auto fail = [&](RpcCode code, const std::string& message) {
    parts_.statistics.counters.add("requests_failed");
    log_limited(LogLevel::kWarning, "request_failed", std::to_string(static_cast<int>(code)),
                {{"method", request.method}, {"reason", message}});
    return request.is_notification ? std::string() : error_line(request.id, code, message);
  };
  try {
    parts_.statistics.counters.add("requests");
    request = open(line);
    const auto method = methods().find(request.method);
    if (method == methods().end()) {
      std::vector<std::string> known;
      for (const auto& [name, ignored] : methods()) known.push_back(name);
      throw RpcError(RpcCode::kNoMethod, "method: none is called '" + request.method + "'; did you mean " +
                                             nearest_word(request.method, known) + "?");
    }
    const bool is_silent = request.is_notification;
    const Reply reply = (this->*method->second)({request, [later, client, is_silent](std::string text) {
                                                   later(client, is_silent ? std::string() : std::move(text));
                                                 }});
    if (!reply) return std::nullopt;
    return is_silent ? std::string() : result_line(request.id, *reply);
  } catch (const RpcError& error) {
    return fail(error.code, error.what());
  } catch (const InputError& error) {
    return fail(RpcCode::kBadInput, error.what());
  } catch (const std::exception& error) {
    return fail(RpcCode::kBadInput, std::string("internal: ") + error.what());
  }
}

/// Out of its envelope, if it is in one; refused, if it must be and is not.
RpcRequest Control::open(const std::string& line) {
  SignedCommand command;
  const bool is_signed = parse_signed_command(line, command).empty();
  if (!is_signed) {
    RpcRequest request = parse_request(line);
    if (!verifier_ || !kSignedMethods.contains(request.method)) return request;
    parts_.statistics.counters.add("commands_refused_unsigned");
    throw RpcError(RpcCode::kRefused,
                   request.method + ": expected a signed command, found one without (--key FILE)");
  }
  if (!verifier_)
    throw RpcError(RpcCode::kRefused, "this daemon has no key (service.key_file): send commands unsigned");
  if (const CommandFault fault = verifier_->judge(command, utime_now()); fault != CommandFault::kNone) {
    parts_.statistics.counters.add("commands_refused_" + name(fault));
    throw RpcError(RpcCode::kRefused, "signed command: refused, " + name(fault));
  }
  return parse_request(command.text);
}

void Control::no_model(const std::string& name) const {
  for (const BrokenModel& model : parts_.registry.broken())
    if (model.entry.name == name)
      throw RpcError(RpcCode::kNoModel, "models: '" + name + "' cannot be loaded: " + model.fault);
  const std::vector<std::string> known = parts_.registry.names();
  throw RpcError(
      RpcCode::kNoModel,
      "models: none is called '" + name + "'" +
          (known.empty() ? "; none is registered" : "; did you mean " + nearest_word(name, known) + "?"));
}

}  // namespace edgepose
