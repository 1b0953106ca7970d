#pragma once
#include <string>

#include "server/training_request.h"

namespace edgepose {

/// What the daemon tells its training child, as one JSON text.
struct TrainingOrder {
  TrainingRequest request;
  std::string model_out, plan_out;  ///< where the files go
  TrainOptions options;
};

std::string to_text(const TrainingOrder& order);
TrainingOrder parse_order(const std::string& text);

/// What the child answers.
struct TrainingReport {
  bool has_plan = false;
  double seconds = 0;
  std::vector<std::string> notes;
};

std::string to_text(const TrainingReport& report);
/// Throws InputError: the child is not trusted with what it prints either.
TrainingReport parse_report(const std::string& text);

}  // namespace edgepose
