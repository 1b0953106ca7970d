#pragma once
#include <nlohmann/json.hpp>
#include <string>

namespace edgepose {

/// One line; what is no UTF-8 becomes U+FFFD.
inline std::string text_of(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace edgepose
