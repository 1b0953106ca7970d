#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/drill_plan.h"
#include "matcher/model.h"

namespace edgepose {

/// A model that the daemon knows. Immutable.
struct RegisteredModel {
  std::string name;
  Model model;
  int64_t content_hash = 0;                      ///< the model file's checksum
  std::optional<DrillPlan> plan = std::nullopt;  ///< checked against the model
  bool active = true;                            ///< looked for in every frame
  std::string mesh = "";                         ///< path that it was made from, for people
  std::string file = "", plan_file = "";         ///< names in the state folder; plan_file empty: no plan
  int64_t registered_utime = 0;                  ///< [us] since 1970, UTC
};

using ModelHandle = std::shared_ptr<const RegisteredModel>;
/// What holds for one frame, in the order of registration.
using ModelList = std::vector<ModelHandle>;

}  // namespace edgepose
