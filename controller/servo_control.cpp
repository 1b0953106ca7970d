#include "controller/servo_control.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "bus/steady_clock.h"
#include "common/error.h"
#include "common/nearest_word.h"
#include "daemon/json_text.h"
#include "daemon/log.h"
#include "daemon/params.h"

namespace edgepose {
namespace {

using nlohmann::json;

const std::vector<std::string> kMethods = {"arm", "go", "homed", "reset", "shutdown", "status", "stop"};

json joints_json(const JointVector& joints) {
  if (!joints.allFinite()) return nullptr;  // not known: the drives have not been set up
  return std::vector<double>(joints.begin(), joints.end());
}

}  // namespace

ServoControl::ServoControl(ControlLoop& loop, PoseInbox& poses, ControllerFacts facts,
                           std::function<void()> shutdown)
    : loop_(loop), poses_(poses), facts_(std::move(facts)), shutdown_(std::move(shutdown)) {}

std::optional<std::string> ServoControl::handle(LineServer::ClientId client, const std::string& line,
                                                const Later& later) {
  RpcRequest request;
  const auto fail = [&](RpcCode code, const std::string& message) {
    log_limited(LogLevel::kWarning, "request_failed", std::to_string(static_cast<int>(code)),
                {{"method", request.method}, {"reason", message}});
    return request.is_notification ? std::string() : error_line(request.id, code, message);
  };
  try {
    request = parse_request(line);
    const std::optional<std::string> reply = run(request, client, later);
    if (!reply) return std::nullopt;
    return request.is_notification ? std::string() : result_line(request.id, *reply);
  } catch (const RpcError& error) {
    return fail(error.code, error.what());
  } catch (const InputError& error) {
    return fail(RpcCode::kBadInput, error.what());
  } catch (const std::exception& error) {
    return fail(RpcCode::kBadInput, std::string("internal: ") + error.what());
  }
}

std::optional<std::string> ServoControl::run(const RpcRequest& request, LineServer::ClientId client,
                                             const Later& later) {
  const std::string& method = request.method;
  const Params params(request.params,
                      method == "go" ? std::vector<std::string>{"target"} : std::vector<std::string>{});
  if (method == "stop") {
    loop_.stop();
    log_event(LogLevel::kInfo, "stop_requested", {});
    return text_of({{"stopping", true}});
  }
  if (method == "status") return status();
  if (method == "shutdown") {
    shutdown_();
    return text_of({{"stopping", true}});
  }
  if (method == "arm") {
    post({ArmCommand::kArm, {}}, request, client, later);
  } else if (method == "reset") {
    post({ArmCommand::kReset, {}}, request, client, later);
  } else if (method == "homed") {
    post({ArmCommand::kHomed, {}}, request, client, later);
  } else if (method == "go") {
    const std::string target = params.text("target");
    const SeenTarget seen = poses_.find(target, 1e-9 * static_cast<double>(steady_ns()));
    const ServoState state = loop_.newest().servo.state;
    if (state != ServoState::kArmed)
      throw RpcError(RpcCode::kRefused, "go is refused while " + std::string(state_name(state)));
    post({ArmCommand::kGo, seen.hole}, request, client, later, target);
  } else {
    throw RpcError(RpcCode::kNoMethod, "method: none is called '" + method + "'; did you mean " +
                                           nearest_word(method, kMethods) + "?");
  }
  return std::nullopt;
}

void ServoControl::post(ArmRequest what, const RpcRequest& request, LineServer::ClientId client,
                        const Later& later, const std::string& target) {
  const std::scoped_lock lock(mutex_);
  if (waiting_ || !loop_.post(what))
    throw RpcError(RpcCode::kBusy, request.method + " is refused while another command is worked on");
  waiting_ = Waiting{request, client, later, target, what.goal};
}

void ServoControl::finish_requests() {
  const std::optional<std::string> answer = loop_.take_answer();
  if (!answer) return;
  std::optional<Waiting> waiting;
  {
    const std::scoped_lock lock(mutex_);
    waiting = std::exchange(waiting_, std::nullopt);
    if (waiting && answer->empty() && !waiting->target.empty()) {
      target_ = waiting->target;
      poses_.follow(waiting->target, waiting->hole);
    }
  }
  const ServoState state = loop_.newest().servo.state;
  log_event(answer->empty() ? LogLevel::kInfo : LogLevel::kWarning, "command",
            {{"method", waiting ? waiting->request.method : ""},
             {"state", state_name(state)},
             {"refused", *answer}});
  if (!waiting) return;
  const RpcRequest& request = waiting->request;
  std::string line = answer->empty() ? result_line(request.id, text_of({{"done", request.method}}))
                                     : error_line(request.id, RpcCode::kRefused, *answer);
  waiting->later(waiting->client, request.is_notification ? std::string() : std::move(line));
}

std::string ServoControl::target() const {
  const std::scoped_lock lock(mutex_);
  return target_;
}

std::string ServoControl::status() const {
  const ControlSample sample = loop_.newest();
  const ServoSample& s = sample.servo;
  const CycleTimes& times = loop_.times();
  json goal;
  if (s.goal_seen)
    goal = {{"standoff_m", s.standoff},
            {"tool_error_m", s.tool_error.translation},
            {"tool_angle_rad", s.tool_error.rotation}};
  return text_of({{"version", facts_.version},
                  {"state", state_name(s.state)},
                  {"fault", loop_.fault_text()},
                  {"drives", name_of(sample.phase)},
                  {"target", target()},
                  {"goal", goal},
                  {"joints_rad", joints_json(s.measured)},
                  {"bus", facts_.bus},
                  {"lcm_url", facts_.lcm_url},
                  {"model", facts_.model},
                  {"taught", facts_.is_taught},
                  {"authentication", facts_.is_signed},
                  {"poses_taken", sample.poses_taken},
                  {"poses_refused", sample.poses_refused},
                  {"messages", poses_.counters().all()},
                  {"cycles_not_recorded", loop_.samples().dropped()},
                  {"frames_not_recorded", loop_.frames().dropped()},
                  {"cycles", times.cycles()},
                  {"cycles_missed", times.missed()},
                  {"late_p50_s", times.late(0.5)},
                  {"late_p99.9_s", times.late(0.999)},
                  {"late_worst_s", times.worst_late()},
                  {"ended_p99.9_s", times.ended(0.999)},
                  {"not_real_time", loop_.real_time_fault()}});
}

}  // namespace edgepose
