#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "reporting/match_json.h"

namespace edgepose {

/// Prints it, indented, with a line end. What is no UTF-8, in the name of a file say, becomes U+FFFD.
void print_json(std::ostream& out, const nlohmann::json& report);

/// For people: one row a detection, millimetres and degrees; then the reason where nothing was found.
void print_table(std::ostream& out, const std::vector<NamedResult>& results, const std::string& frame,
                 double preprocessing_seconds);

}  // namespace edgepose
