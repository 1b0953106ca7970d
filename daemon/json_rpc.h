#pragma once
#include <functional>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <stdexcept>
#include <string>

namespace edgepose {

/// Codes of docs/control.md; the negative ones are JSON-RPC's own.
enum class RpcCode : int {
  kNoJson = -32700,
  kNoRequest = -32600,
  kNoMethod = -32601,
  kBadParams = -32602,
  kBadInput = 1,
  kNoModel = 2,
  kNameTaken = 3,
  kTrainingFailed = 4,
  kBusy = 5,
  kRefused = 6,
  kNoFrame = 7,
};

class RpcError : public std::runtime_error {
 public:
  RpcError(RpcCode why, const std::string& message) : std::runtime_error(message), code(why) {}
  RpcCode code;
};

/// A request, taken apart. `id` and `params` are JSON texts ("null" and "{}" where there are none).
struct RpcRequest {
  std::string id = "null", method, params = "{}";
  bool is_notification = false;  ///< without an id: nothing is answered
};

/// Throws RpcError: no JSON, no request (an array of requests is none either: one a line).
RpcRequest parse_request(const std::string& line);

/// One line each. `result` is a JSON text.
std::string result_line(const std::string& id, const std::string& result);
std::string error_line(const std::string& id, RpcCode code, const std::string& message);

}  // namespace edgepose
