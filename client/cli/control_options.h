#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "client/service/control_client.h"

namespace edgepose {

/// Where the daemon is, and how it is spoken to: --socket, --tcp, --key, --timeout and --json.
struct ControlOptions {
  std::filesystem::path socket, key;
  int port = 0;
  double timeout = 30;  ///< [s] for each answer
  bool as_json = false;

  void add_to(CLI::App& command, double default_timeout = 30);
  /// Throws InputError as ControlClient does.
  nlohmann::json call(const std::string& method, const nlohmann::json& params,
                      const ControlClient::Waiting& waiting = {}) const;
};

/// A member of an answer as text for people, whatever the daemon has put there; "-" for none or null.
/// Printable.
std::string text_of(const nlohmann::json& object, const char* key);
/// A number, multiplied, with `decimals`; "-" if it is none.
std::string number_of(const nlohmann::json& object, const char* key, double factor, int decimals);
/// A member, or null.
const nlohmann::json& member(const nlohmann::json& object, const char* key);

}  // namespace edgepose
