#pragma once
#include <functional>
#include <optional>
#include <string>

#include "simulator/drive_thread.h"
#include "simulator/sim_publisher.h"

namespace edgepose {

/// What commands reach.
struct SimParts {
  const WorkCell& cell;
  const DrillTarget& target;
  SimulatedBus& bus;
  DriveThread& drives;
  SimPublisher& publisher;
  std::function<void()> shutdown;
};

/// Answers one request (JSON-RPC 2.0, one a line; docs/simulator.md lists the methods) with one line; empty
/// for a notification. Never throws. To be called from one thread at a time.
std::string answer_sim_command(const SimParts& parts, const std::string& line);

}  // namespace edgepose
