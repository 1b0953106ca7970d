#pragma once
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

#include "client/service/pose_comparison.h"
#include "client/service/truth_comparison.h"

namespace edgepose {

/// For people: one row a model, millimetres and degrees.
void print_table(std::ostream& out, const Comparison& comparison);
void print_table(std::ostream& out, const TruthComparison& comparison);

/// SI units.
nlohmann::json to_json(const Comparison& comparison);
nlohmann::json to_json(const TruthComparison& comparison);

}  // namespace edgepose
