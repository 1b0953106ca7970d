/// The commands that are about models.
#include "common/error.h"
#include "daemon/json_text.h"
#include "daemon/params.h"
#include "reporting/match_json.h"
#include "server/control.h"
#include "server/training.h"

namespace edgepose {
namespace {

using nlohmann::json;

json summary(const RegisteredModel& m) {
  return {{"name", m.name},
          {"active", m.active},
          {"content_hash", m.content_hash},
          {"diameter", m.model.diameter()},
          {"points", m.model.point_count()},
          {"symmetric", !m.model.symmetries().empty()},
          {"plan", m.plan ? json(m.plan->targets.size()) : json()},
          {"registered_utime", m.registered_utime},
          {"file", m.file}};
}

json in_full(const RegisteredModel& m) {
  json all = summary(m);
  all["mesh"] = m.mesh;
  const Eigen::Vector3d centre = m.model.centre();
  all["centre"] = {centre.x(), centre.y(), centre.z()};
  all["file_bytes"] = m.model.block().size();
  const Symmetries symmetries = m.model.symmetries();
  all["symmetries"] = {{"discrete", symmetries.discrete.size()},
                       {"continuous", symmetries.continuous.size()}};
  json targets = json::array();
  if (m.plan)
    for (const DrillTarget& target : m.plan->targets) targets.push_back(target.name);
  all["plan_targets"] = targets;
  return all;
}

TrainingRequest training_request(const Params& params) {
  TrainingRequest request;
  if (params.has("mesh") == params.has("model"))
    throw RpcError(RpcCode::kBadParams, "params: expected either mesh or model, found " +
                                            std::string(params.has("mesh") ? "both" : "neither"));
  if (params.has("mesh")) request.mesh = params.path("mesh");
  if (params.has("model")) request.model = params.path("model");
  if (params.has("plan")) request.plan = params.path("plan");
  const std::filesystem::path source(request.mesh.empty() ? request.model : request.mesh);
  request.name = params.text("name", source.stem().string());
  request.unit = params.text("unit", "mm");
  if (request.unit != "mm" && request.unit != "m")
    throw RpcError(RpcCode::kBadParams, "params.unit: expected mm or m, found '" + request.unit + "'");
  request.any_size = params.flag("any_size", false);
  request.activate = params.flag("activate", true);
  if (const std::string fault = name_fault(request.name); !fault.empty())
    throw RpcError(RpcCode::kBadParams, "params." + fault);
  return request;
}

std::pair<RpcCode, std::string> reason_of(const std::exception_ptr& failure) {
  try {
    std::rethrow_exception(failure);
  } catch (const NameTaken& error) {
    return {RpcCode::kNameTaken, error.what()};
  } catch (const TrainingFailure& error) {
    return {RpcCode::kTrainingFailed, error.what()};
  } catch (const std::exception& error) {
    return {RpcCode::kBadInput, error.what()};
  }
}

}  // namespace

Control::Reply Control::list_models(const Call& call) {
  const Params params(call.request.params, {});
  json list = json::array();
  for (const ModelHandle& model : parts_.registry.all()) list.push_back(summary(*model));
  for (const BrokenModel& model : parts_.registry.broken())
    list.push_back({{"name", model.entry.name}, {"active", false}, {"fault", model.fault}});
  return text_of(list);
}

Control::Reply Control::get_model(const Call& call) {
  const Params params(call.request.params, {"name"});
  const ModelHandle model = parts_.registry.find(params.text("name"));
  if (model == nullptr) no_model(params.text("name"));
  return text_of(in_full(*model));
}

Control::Reply Control::register_model(const Call& call) {
  const Params params(call.request.params,
                      {"name", "mesh", "model", "unit", "plan", "any_size", "activate", "replace"});
  Counters& counters = parts_.statistics.counters;
  const auto done = [id = call.request.id, finish = call.finish, &counters](
                        const ModelHandle& model, const TrainingResult& result,
                        const std::exception_ptr& failure) {
    if (failure) {
      const auto [code, reason] = reason_of(failure);
      counters.add("registrations_failed");
      return finish(error_line(id, code, reason));
    }
    counters.add("registrations");
    json answer = in_full(*model);
    answer["training_seconds"] = result.seconds;
    answer["notes"] = result.notes;
    finish(result_line(id, text_of(answer)));
  };
  if (!parts_.registrar.post({training_request(params), params.flag("replace", false), done}))
    throw RpcError(RpcCode::kBusy, "models.register: too many registrations wait; try again later");
  return std::nullopt;
}

Control::Reply Control::unregister_model(const Call& call) {
  const Params params(call.request.params, {"name"});
  const std::string name = params.text("name");
  if (!parts_.registry.remove(name)) no_model(name);
  return text_of({{"name", name}});
}

Control::Reply Control::activate_model(const Call& call) {
  const Params params(call.request.params, {"name", "active"});
  const ModelHandle model = parts_.registry.activate(params.text("name"), params.flag("active", true));
  if (model == nullptr) no_model(params.text("name"));
  return text_of(in_full(*model));
}

}  // namespace edgepose
