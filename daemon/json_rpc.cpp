#include "daemon/json_rpc.h"

#include <nlohmann/json.hpp>

#include "common/error.h"
#include "daemon/json_text.h"

namespace edgepose {
namespace {

using nlohmann::json;

}  // namespace

RpcRequest parse_request(const std::string& line) {
  json whole;
  try {
    whole = json::parse(line);
  } catch (const json::exception& error) {
    throw RpcError(RpcCode::kNoJson, one_line(std::string("request: expected JSON: ") + error.what()));
  }
  if (!whole.is_object() || whole.value("jsonrpc", json()) != "2.0" || !whole.contains("method") ||
      !whole["method"].is_string())
    throw RpcError(
        RpcCode::kNoRequest,
        R"(request: expected {"jsonrpc":"2.0","id":...,"method":"...","params":{...}}, one a line)");
  RpcRequest request;
  request.method = whole["method"].get<std::string>();
  request.is_notification = !whole.contains("id");
  if (!request.is_notification) {
    const json& id = whole["id"];
    if (!id.is_string() && !id.is_number() && !id.is_null())
      throw RpcError(RpcCode::kNoRequest, "id: expected a text, a number or null, found another");
    request.id = text_of(id);
  }
  if (whole.contains("params")) {
    if (!whole["params"].is_object())
      throw RpcError(RpcCode::kBadParams, "params: expected an object with names, found another");
    request.params = text_of(whole["params"]);
  }
  return request;
}

std::string result_line(const std::string& id, const std::string& result) {
  return R"({"jsonrpc":"2.0","id":)" + id + R"(,"result":)" + result + "}";
}

std::string error_line(const std::string& id, RpcCode code, const std::string& message) {
  const json error = {{"code", static_cast<int>(code)}, {"message", message}};
  return R"({"jsonrpc":"2.0","id":)" + id + R"(,"error":)" + text_of(error) + "}";
}

}  // namespace edgepose
