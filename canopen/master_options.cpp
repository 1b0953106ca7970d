#include "canopen/master_options.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "canopen/cob_id.h"

namespace edgepose {
namespace {

void demand(bool fact, const std::string& field, const std::string& expected, double found) {
  if (!fact)
    throw std::invalid_argument(field + ": expected " + expected + ", found " + std::to_string(found));
}

}  // namespace

void MasterOptions::check() const {
  for (size_t i = 0; i < nodes.size(); ++i) {
    demand(nodes[i] >= 1 && nodes[i] <= cob_id::kMaxNode, "nodes", "1 to 127", nodes[i]);
    demand(nodes[i] != master_node, "nodes", "numbers other than master_node", nodes[i]);
    demand(std::count(nodes.begin(), nodes.end(), nodes[i]) == 1, "nodes", "each number once", nodes[i]);
    demand(min_position[i] < max_position[i], "max_position", "more than min_position", max_position[i]);
    demand(std::abs(min_position[i]) <= 100, "min_position", "at most 100 rad", min_position[i]);
    demand(std::abs(max_position[i]) <= 100, "max_position", "at most 100 rad", max_position[i]);
    demand(max_velocity[i] > 0 && max_velocity[i] <= 100, "max_velocity", "0 to 100 rad/s", max_velocity[i]);
  }
  demand(master_node >= 1 && master_node <= cob_id::kMaxNode, "master_node", "1 to 127", master_node);
  demand(scale.counts_per_turn >= 100 && scale.counts_per_turn <= 1 << 24, "scale.counts_per_turn",
         "100 to 2^24", scale.counts_per_turn);
  const double ms = cycle * 1e3;
  demand(ms >= 1 && ms <= 20 && std::abs(ms - std::round(ms)) < 1e-9, "cycle", "1 to 20 whole ms", cycle);
  demand(quick_stop_deceleration > 0 && quick_stop_deceleration < 1000, "quick_stop_deceleration",
         "0 to 1000 rad/s^2", quick_stop_deceleration);
  demand(rpdo_timeout > cycle && rpdo_timeout <= 1, "rpdo_timeout", "more than a cycle, at most 1 s",
         rpdo_timeout);
  demand(
      drive_heartbeat_timeout > drive_heartbeat && drive_heartbeat >= 0.001 && drive_heartbeat_timeout <= 10,
      "drive_heartbeat_timeout", "more than drive_heartbeat, at most 10 s", drive_heartbeat_timeout);
  demand(master_heartbeat_timeout > master_heartbeat && master_heartbeat >= cycle &&
             master_heartbeat_timeout <= 10,
         "master_heartbeat_timeout", "more than master_heartbeat, at most 10 s", master_heartbeat_timeout);
  demand(max_missed >= 1 && max_missed <= 20, "max_missed", "1 to 20", max_missed);
  demand(max_no_room >= 1 && max_no_room <= 20, "max_no_room", "1 to 20", max_no_room);
  demand(max_waiting_syncs >= 1 && max_waiting_syncs <= 20, "max_waiting_syncs", "1 to 20",
         max_waiting_syncs);
  demand(max_frames_a_cycle >= 64, "max_frames_a_cycle", "at least 64", max_frames_a_cycle);
}

std::vector<uint16_t> MasterOptions::received_ids() const {
  std::vector<uint16_t> ids;
  for (const int node : nodes)
    for (const uint16_t function :
         {cob_id::kEmergency, cob_id::kTpdo1, cob_id::kTpdo2, cob_id::kSdoAnswer, cob_id::kHeartbeat})
      ids.push_back(static_cast<uint16_t>(function + node));
  return ids;
}

}  // namespace edgepose
