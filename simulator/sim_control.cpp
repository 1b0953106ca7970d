#include "simulator/sim_control.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "daemon/json_rpc.h"
#include "daemon/json_text.h"

namespace edgepose {
namespace {

using nlohmann::json;

[[noreturn]] void refuse(const std::string& name, const std::string& expected, const json& found) {
  throw RpcError(RpcCode::kBadParams, "params." + name + ": expected " + expected + ", found " +
                                          (found.is_discarded() ? "none" : text_of(found).substr(0, 100)));
}

/// The parameters of one request. Each one that was not asked for is refused.
class SimParams {
 public:
  explicit SimParams(const std::string& text) : values_(json::parse(text)) {}

  double number(const std::string& name, double least, double most, std::optional<double> otherwise = {}) {
    const json value = take(name);
    if (value.is_discarded() && otherwise) return *otherwise;
    const std::string range = "a number from " + text_of(least) + " to " + text_of(most);
    if (!value.is_number()) refuse(name, range, value);
    const auto found = value.get<double>();
    if (!(found >= least && found <= most)) refuse(name, range, value);
    return found;
  }
  int whole(const std::string& name, int least, int most, std::optional<double> otherwise = {}) {
    const double found = number(name, least, most, otherwise);
    if (found != std::floor(found)) refuse(name, "a whole number", found);
    return static_cast<int>(found);
  }
  bool flag(const std::string& name, bool otherwise) {
    const json value = take(name);
    if (value.is_discarded()) return otherwise;
    if (!value.is_boolean()) refuse(name, "true or false", value);
    return value.get<bool>();
  }
  std::string word(const std::string& name) {
    const json value = take(name);
    if (!value.is_string()) refuse(name, "a word", value);
    return value.get<std::string>();
  }
  void done() const {
    if (!values_.empty())
      throw RpcError(RpcCode::kBadParams, "params: no parameter is called '" + values_.begin().key() + "'");
  }

 private:
  json take(const std::string& name) {
    const auto found = values_.find(name);
    if (found == values_.end()) return json(json::value_t::discarded);
    json value = *found;
    values_.erase(found);
    return value;
  }
  json values_;
};

json provoke(const SimParts& parts, SimParams& params) {
  const int node = params.whole("node", 1, kJoints);
  const std::string name = params.word("kind");
  const bool on = params.flag("on", true);
  params.done();
  const auto kind = provocation_named(name);
  if (!kind) refuse("kind", provocation_names(), name);
  parts.drives.with([&](SimulatedArm& arm) { arm.provoke(node - 1, *kind, on); });
  return json::object();
}

json poses(const SimParts& parts, SimParams& params) {
  const std::string name = params.word("wrong");
  const int count = params.whole("count", 0, 1'000'000, 0);
  params.done();
  const auto wrong = pose_wrong_named(name);
  if (!wrong) refuse("wrong", pose_wrong_names(), name);
  parts.publisher.set_wrong(*wrong, count);
  return json::object();
}

json drop_sync(const SimParts& parts, SimParams& params) {
  const int count = params.whole("count", 0, 1'000'000);
  params.done();
  parts.drives.with([&](SimulatedArm& arm) { arm.drop_syncs(count); });
  return json::object();
}

json flood(const SimParts& parts, SimParams& params) {
  const double seconds = params.number("seconds", 0, 60);
  params.done();
  if (!parts.bus.flood(seconds)) throw RpcError(RpcCode::kBusy, "flood: the bus is flooded already, or down");
  return json::object();
}

json bus(const SimParts& parts, SimParams& params) {
  const bool off = params.flag("off", false), down = params.flag("down", false);
  params.done();
  if (off) parts.bus.report_bus_off();
  if (down && !parts.bus.take_down())
    throw RpcError(RpcCode::kRefused, "bus: a CAN interface is not ours to take down; ip link set ... down");
  return json::object();
}

json status(const SimParts& parts, SimParams& params) {
  params.done();
  const TruthSample truth = parts.drives.truth();
  const DriveTimes times = parts.drives.times();
  const PublisherCounts counts = parts.publisher.counts();
  const PositioningError error = positioning_error(parts.cell, truth.position, parts.target);
  json drives = json::array();
  for (int axis = 0; axis < kJoints; ++axis)
    drives.push_back({{"node", axis + 1},
                      {"position_rad", truth.position[axis]},
                      {"velocity_rad_s", truth.velocity[axis]},
                      {"state", name_of(truth.states[static_cast<size_t>(axis)])}});
  return {{"time_ns", truth.time_ns},
          {"drives", drives},
          {"target", parts.target.name},
          {"tip_along_m", error.along},
          {"tip_across_m", error.across},
          {"axis_angle_rad", error.angle},
          {"bus", parts.bus.name()},
          {"bus_up", parts.bus.is_up()},
          {"bus_members", parts.bus.members()},
          {"flooded", parts.bus.is_flooded()},
          {"flood_frames", parts.bus.flood_frames()},
          {"steps", times.steps},
          {"worst_late_s", 1e-9 * static_cast<double>(times.worst_late_ns)},
          {"poses_wrong", parts.publisher.wrong()},
          {"messages", counts.messages},
          {"messages_failed", counts.failed},
          {"capture_s", counts.capture_seconds}};
}

json shutdown(const SimParts& parts, SimParams& params) {
  params.done();
  parts.shutdown();
  return json::object();
}

using SimMethod = json (*)(const SimParts&, SimParams&);
const std::map<std::string, SimMethod> kSimMethods = {
    {"provoke", provoke}, {"poses", poses},   {"drop_sync", drop_sync}, {"flood", flood},
    {"bus", bus},         {"status", status}, {"shutdown", shutdown}};

}  // namespace

std::string answer_sim_command(const SimParts& parts, const std::string& line) {
  RpcRequest request;
  const auto fail = [&](RpcCode code, const std::string& message) {
    return request.is_notification ? std::string() : error_line(request.id, code, message);
  };
  try {
    request = parse_request(line);
    const auto method = kSimMethods.find(request.method);
    if (method == kSimMethods.end()) {
      std::string known;
      for (const auto& [name, ignored] : kSimMethods) known += (known.empty() ? "" : ", ") + name;
      return fail(RpcCode::kNoMethod,
                  "method: expected one of " + known + "; found '" + request.method + "'");
    }
    SimParams params(request.params);
    const std::string result = text_of(method->second(parts, params));
    return request.is_notification ? std::string() : result_line(request.id, result);
  } catch (const RpcError& error) {
    return fail(error.code, one_line(error.what()));
  } catch (const InputError& error) {
    return fail(RpcCode::kBadInput, error.what());
  } catch (const std::exception& error) {
    return fail(RpcCode::kBadInput, one_line(std::string("internal: ") + error.what()));
  }
}

}  // namespace edgepose
