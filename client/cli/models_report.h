#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace edgepose {

/// What the daemon says of its models (docs/control.md), for people. Members that are missing or of another
/// type are shown as "-".
void print_models(std::ostream& out, const nlohmann::json& models);
void print_model(std::ostream& out, const nlohmann::json& model);

}  // namespace edgepose
