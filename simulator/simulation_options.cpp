#include "simulator/simulation_options.h"

#include "matcher/option_range.h"

namespace edgepose {

std::string SimulationOptions::check() const {
  if (std::string fault = cell.check(); !fault.empty()) return fault;
  if (bus.empty() || bus.starts_with("pcap:"))
    return "bus: expected unix:/path or a CAN interface, found '" + bus + "'";
  return option_fault({{"rate", rate, 0, 100},
                       {"duplicate-node", static_cast<double>(duplicate_node), 0, kJoints},
                       {"absent-node", static_cast<double>(absent_node), 0, kJoints},
                       {"foreign-node", static_cast<double>(foreign_node), 0, kJoints}});
}

}  // namespace edgepose
