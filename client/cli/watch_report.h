#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "edgepose_lcm/drill_targets_t.hpp"
#include "edgepose_lcm/pose_estimates_t.hpp"
#include "edgepose_lcm/service_status_t.hpp"

namespace edgepose {

/// One detection, or why there is none, as a row of a table; millimetres and degrees. Names from the network
/// are printable in what comes out.
std::string heading_of_poses();
std::vector<std::string> rows(const edgepose_lcm::model_answer_t& answer);
std::string heading_of_targets();
std::string row(const edgepose_lcm::drill_target_t& target);
/// "superseded 3, old 1"; empty if none.
std::string counts(const std::vector<edgepose_lcm::counter_t>& counters);

/// A message in one line. `receive_utime`: [us] when it was received here.
std::string line(const edgepose_lcm::pose_estimates_t& answer, int64_t receive_utime);
std::string line(const edgepose_lcm::drill_targets_t& targets);

/// Everything that it says, SI units, and "type": poses, drill_targets or status.
nlohmann::json to_json(const edgepose_lcm::pose_estimates_t& answer, int64_t receive_utime);
nlohmann::json to_json(const edgepose_lcm::drill_targets_t& targets, int64_t receive_utime);
nlohmann::json to_json(const edgepose_lcm::service_status_t& status, int64_t receive_utime);

/// [s] from the capture to the receipt.
double latency(int64_t capture_utime, int64_t receive_utime);

}  // namespace edgepose
