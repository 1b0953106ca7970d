#pragma once
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/nearest_word.h"
#include "daemon/json_rpc.h"

namespace edgepose {

/// The named parameters of one request. Every getter throws RpcError (kBadParams) that names the parameter,
/// what was expected and what was found.
class Params {
 public:
  /// Only `known` names may be there.
  Params(const std::string& text, const std::vector<std::string>& known)
      : values_(nlohmann::json::parse(text)) {
    for (const auto& [name, value] : values_.items())
      if (std::find(known.begin(), known.end(), name) == known.end())
        throw RpcError(
            RpcCode::kBadParams,
            "params: no parameter is called '" + name + "'" +
                (known.empty() ? "; there is none" : "; did you mean " + nearest_word(name, known) + "?"));
  }

  bool has(const std::string& name) const { return values_.contains(name); }
  std::string text(const std::string& name) const {
    if (!has(name)) throw RpcError(RpcCode::kBadParams, "params." + name + ": expected a text, found none");
    const nlohmann::json& value = values_[name];
    if (!value.is_string()) wrong(name, "a text");
    auto text = value.get<std::string>();
    if (text.empty() || text.find('\0') != std::string::npos) wrong(name, "a text that is not empty");
    return text;
  }
  std::string text(const std::string& name, const std::string& otherwise) const {
    return has(name) ? text(name) : otherwise;
  }
  bool flag(const std::string& name, bool otherwise) const {
    if (!has(name)) return otherwise;
    if (!values_[name].is_boolean()) wrong(name, "true or false");
    return values_[name].get<bool>();
  }
  double number(const std::string& name, double otherwise) const {
    if (!has(name)) return otherwise;
    if (!values_[name].is_number() || !std::isfinite(values_[name].get<double>())) wrong(name, "a number");
    return values_[name].get<double>();
  }
  std::vector<std::string> texts(const std::string& name) const {
    if (!values_[name].is_array()) wrong(name, "an array of texts");
    std::vector<std::string> all;
    for (const nlohmann::json& value : values_[name]) {
      if (!value.is_string()) wrong(name, "an array of texts");
      all.push_back(value.get<std::string>());
    }
    return all;
  }
  /// An absolute path: the daemon does not know where its client is.
  std::string path(const std::string& name) const {
    std::string value = text(name);
    if (value.front() != '/') wrong(name, "an absolute path");
    return value;
  }

 private:
  [[noreturn]] void wrong(const std::string& name, const std::string& expected) const {
    throw RpcError(
        RpcCode::kBadParams,
        "params." + name + ": expected " + expected + ", found " +
            values_[name].dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).substr(0, 100));
  }

  nlohmann::json values_;
};

}  // namespace edgepose
