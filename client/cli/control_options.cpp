#include "client/cli/control_options.h"

#include <nlohmann/json.hpp>

#include "client/cli/lcm_options.h"
#include "client/cli/option_checks.h"
#include "client/cli/text.h"
#include "common/error.h"
#include "settings/control_address.h"

namespace edgepose {

using nlohmann::json;

void ControlOptions::add_to(CLI::App& command, double default_timeout) {
  timeout = default_timeout;
  auto* socket_option = command.add_option(
      "--socket", socket,
      "The daemon's Unix socket (default: $EDGEPOSE_SOCKET, else " + default_control_socket().string() + ")");
  command.add_option("--tcp", port, "The daemon's TCP port of this machine instead")
      ->check(CLI::Range(1, 65535))
      ->excludes(socket_option);
  command.add_option("--key", key, "Key file to sign commands with, if the daemon demands it");
  command
      .add_option("--timeout", timeout,
                  "[s] How long to wait for the answer (default " +
                      std::to_string(static_cast<int>(default_timeout)) + ")")
      ->check(number_between(0.001, kMaxSeconds));
  command.add_flag("--json", as_json, "Print the daemon's answer as JSON (docs/control.md)");
}

json ControlOptions::call(const std::string& method, const json& params,
                          const ControlClient::Waiting& waiting) const {
  const std::optional<SecretKey> secret = key.empty() ? std::nullopt : std::optional(SecretKey::read(key));
  ControlAddress address;
  address.socket = socket.empty() ? default_control_socket() : socket;
  address.port = port;
  return ControlClient(address, secret).call(method, params, timeout, waiting);
}

const json& member(const json& object, const char* key) {
  static const json kNone;
  if (!object.is_object()) return kNone;
  const auto found = object.find(key);
  return found == object.end() ? kNone : *found;
}

std::string text_of(const json& object, const char* key) {
  const json& value = member(object, key);
  if (value.is_null()) return "-";
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string()) return one_line(value.get<std::string>());
  if (!value.is_array()) return value.dump(-1, ' ', false, json::error_handler_t::replace);
  std::string list;
  for (const json& item : value)
    list += (list.empty() ? "" : ", ") + (item.is_string()
                                              ? one_line(item.get<std::string>())
                                              : item.dump(-1, ' ', false, json::error_handler_t::replace));
  return list.empty() ? "-" : list;
}

std::string number_of(const json& object, const char* key, double factor, int decimals) {
  const json& value = member(object, key);
  return value.is_number() ? formatted("%.*f", decimals, factor * value.get<double>()) : "-";
}

}  // namespace edgepose
