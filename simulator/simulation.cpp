#include "simulator/simulation.h"

#include <cstdio>
#include <optional>

#include "calibration/utc_now.h"
#include "common/error.h"
#include "daemon/counters.h"
#include "daemon/keep_awake.h"
#include "daemon/line_server.h"
#include "daemon/log.h"
#include "daemon/signals.h"
#include "simulator/sim_control.h"
#include "simulator/starts.h"

namespace edgepose {
namespace {

SimulatedArmOptions arm_options(const WorkCell& cell, const DrillTarget& target,
                                const SimulationOptions& options) {
  SimulatedArmOptions arm;
  arm.start = options.start == SimStart::kRandom ? draw_start(cell, target, options.seed)
                                                 : standoff_start(cell, target);
  arm.duplicate_axis = options.duplicate_node - 1;
  arm.absent_axis = options.absent_node - 1;
  if (options.foreign_node > 0) arm.identities[static_cast<size_t>(options.foreign_node - 1)].vendor = 0x9a8b;
  return arm;
}

class Simulation {
 public:
  explicit Simulation(const SimulationOptions& options)
      : cell_(make_work_cell(options.cell)),
        target_(cell_.find_target(cell_.target)),
        told_(draw_told(cell_, options.noise ? ToldNoise{} : ToldNoise::none(), options.seed)),
        bus_(options.bus) {
    if (options.keep_awake) keep_awake_.emplace();
    if (!options.told.empty()) write_told(options.told, told_, utc_now());
    if (!options.truth.empty()) log_.emplace(options.truth, cell_, target_);
    drives_.emplace(bus_, arm_options(cell_, target_, options), log_ ? &*log_ : nullptr);
    publisher_.emplace(cell_, target_, told_, options, *drives_);
    if (!options.control.empty()) serve(options.control);
    say_ready(options);
  }
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  void run() {
    constexpr int kTick = 1000;  // [ms]
    while (signals_.wait(kTick) != Wake::kEnd) {
      if (server_ && server_->failed()) throw InputError("control: the system refuses to wait for commands");
    }
    const DriveTimes times = drives_->times();
    log_event(LogLevel::kInfo, "stopping",
              {{"steps", std::to_string(times.steps)},
               {"worst_late_us", std::to_string(times.worst_late_ns / 1000)},
               {"truth_lost", std::to_string(log_ ? log_->lost() : 0)}});
  }

 private:
  void serve(const std::filesystem::path& path) {
    std::vector<ListeningSocket> sockets;
    sockets.push_back(ListeningSocket::on_file(path));
    const SimParts parts{cell_, target_, bus_, *drives_, *publisher_, [this] { signals_.end(); }};
    server_.emplace(
        std::move(sockets),
        [parts](LineServer::ClientId, const std::string& line) {
          return std::optional(answer_sim_command(parts, line));
        },
        counters_, LineServerOptions{});
    server_->start();
  }

  void say_ready(const SimulationOptions& options) const {
    log_event(LogLevel::kInfo, "ready",
              {{"bus", options.bus}, {"control", options.control.string()}, {"target", target_.name}});
    if (!options.ready) return;
    std::printf("READY bus=%s control=%s target=%s\n", options.bus.c_str(), options.control.c_str(),
                target_.name.c_str());
    std::fflush(stdout);
  }

  Signals signals_;  // first: threads inherit what is blocked
  std::optional<KeepAwake> keep_awake_;
  const WorkCell cell_;
  const DrillTarget target_;
  const ToldEquipment told_;
  Counters counters_;
  SimulatedBus bus_;
  std::optional<TruthLog> log_;
  std::optional<DriveThread> drives_;
  std::optional<SimPublisher> publisher_;
  std::optional<LineServer> server_;
};

}  // namespace

void run_simulation(const SimulationOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError(fault);
  Simulation simulation(options);
  simulation.run();
}

}  // namespace edgepose
