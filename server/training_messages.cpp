#include "server/training_messages.h"

#include <nlohmann/json.hpp>

#include "common/error.h"

namespace edgepose {

using nlohmann::json;

std::string to_text(const TrainingOrder& o) {
  const TrainOptions& t = o.options;
  const json order = {{"name", o.request.name},
                      {"mesh", o.request.mesh},
                      {"model", o.request.model},
                      {"unit", o.request.unit},
                      {"plan", o.request.plan},
                      {"any_size", o.request.any_size},
                      {"model_out", o.model_out},
                      {"plan_out", o.plan_out},
                      {"options",
                       {{"sampling_step", t.sampling_step},
                        {"distance_step", t.distance_step},
                        {"angle_step_deg", t.angle_step_deg},
                        {"min_normal_angle_deg", t.min_normal_angle_deg},
                        {"max_normal_angle_deg", t.max_normal_angle_deg},
                        {"visibility_filter", t.visibility_filter},
                        {"views", t.views},
                        {"find_symmetries", t.find_symmetries},
                        {"seed", t.seed},
                        {"max_table_mb", t.max_table_mb},
                        {"threads", t.threads}}}};
  return order.dump(-1, ' ', true, json::error_handler_t::replace);
}

TrainingOrder parse_order(const std::string& text) {
  TrainingOrder order;
  try {
    const json o = json::parse(text);
    o.at("name").get_to(order.request.name);
    o.at("mesh").get_to(order.request.mesh);
    o.at("model").get_to(order.request.model);
    o.at("unit").get_to(order.request.unit);
    o.at("plan").get_to(order.request.plan);
    o.at("any_size").get_to(order.request.any_size);
    o.at("model_out").get_to(order.model_out);
    o.at("plan_out").get_to(order.plan_out);
    const json& t = o.at("options");
    TrainOptions& options = order.options;
    t.at("sampling_step").get_to(options.sampling_step);
    t.at("distance_step").get_to(options.distance_step);
    t.at("angle_step_deg").get_to(options.angle_step_deg);
    t.at("min_normal_angle_deg").get_to(options.min_normal_angle_deg);
    t.at("max_normal_angle_deg").get_to(options.max_normal_angle_deg);
    t.at("visibility_filter").get_to(options.visibility_filter);
    t.at("views").get_to(options.views);
    t.at("find_symmetries").get_to(options.find_symmetries);
    t.at("seed").get_to(options.seed);
    t.at("max_table_mb").get_to(options.max_table_mb);
    t.at("threads").get_to(options.threads);
  } catch (const json::exception& error) {
    throw InputError::at("training order", "one that edgeposed writes", error.what());
  }
  return order;
}

std::string to_text(const TrainingReport& report) {
  const json r = {{"has_plan", report.has_plan}, {"seconds", report.seconds}, {"notes", report.notes}};
  return r.dump(-1, ' ', true, json::error_handler_t::replace);
}

TrainingReport parse_report(const std::string& text) {
  TrainingReport report;
  try {
    const json r = json::parse(text);
    r.at("has_plan").get_to(report.has_plan);
    r.at("seconds").get_to(report.seconds);
    r.at("notes").get_to(report.notes);
  } catch (const json::exception& error) {
    throw InputError::at("training child", "a report", error.what());
  }
  return report;
}

}  // namespace edgepose
