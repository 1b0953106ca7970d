#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "experiment/experiment.h"

namespace edgepose {

/// The share of `hits` of `all` and its 95 % interval (Wilson 1927), 0 to 1.
struct Share {
  double share = 0, low = 0, high = 1;
};
Share wilson(size_t hits, size_t all);

/// One row for each arm: median, 95th percentile and most of the true tip's distance and angle, the share
/// within 1 mm and 1 degree, failures, steps. Nothing is left out: a trial that failed counts with where it
/// ended.
std::string results_table(const std::vector<ArmResults>& results);

/// Writes report.md, error_over_steps.png, error_shares.png (if gnuplot is there) into `folder`, all or none.
/// `command`: what made it; `date`: when.
void write_report(const std::filesystem::path& folder, const std::vector<ArmResults>& results,
                  const std::string& command, const std::string& date);

}  // namespace edgepose
