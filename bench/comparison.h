#pragma once
#include <string>
#include <vector>

namespace edgepose::bench {

/// What one method did in the whole run.
struct Tally {
  std::string method, settings;
  double train_seconds = 0;
  size_t objects_trained = 0;
  size_t asked = 0, correct = 0, nothing = 0, timed_out = 0, crashed = 0;
  std::vector<double> seconds;  ///< of each question, preprocessing included; time-outs count as the limit
  std::vector<double> errors;   ///< [m] of the correct poses
};

/// A Markdown table, a row a method, and their settings below it.
std::string comparison_table(const std::vector<Tally>& tallies);

}  // namespace edgepose::bench
