#pragma once
#include <functional>
#include <stop_token>
#include <string>

#include "demo/demo_options.h"

namespace edgepose {

/// How a demonstration ended.
struct DemoEnd {
  bool converged = false;
  std::string verdict;  ///< one line
  std::string warning;  ///< one line, or empty
};

/// Runs pose service, simulator and controller as processes, moves the arm from a random start to the hole,
/// and writes the report. `say` takes lines of progress; `command`: for the report. Bounded in time by the
/// options. To be called from the main thread. Throws InputError if an option is wrong or a program fails,
/// DemoStopped (demo_processes.h) if a stop was asked for; no process is left then, and nothing written.
DemoEnd run_demo(DemoOptions options, const std::string& command, const std::stop_token& stop,
                 const std::function<void(const std::string&)>& say);

}  // namespace edgepose
