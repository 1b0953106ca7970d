#pragma once
#include <optional>

#include "bench/method.h"

namespace edgepose::bench {

enum class Outcome { kAnswered, kNothing, kTimedOut, kCrashed };

struct Answer {
  Outcome outcome = Outcome::kCrashed;
  RigidTransform camera_T_model = RigidTransform::Identity();
  double seconds = 0;  ///< wall time of find(); the limit where it was reached
};

/// Asks in a process of its own, so that a method may hang or crash without ending the comparison.
Answer ask_isolated(Method& method, const Object& object, const Frame& frame, double limit_seconds);

}  // namespace edgepose::bench
