#include "demo/demo_teaching.h"

#include "calibration/utc_now.h"
#include "experiment/trial.h"
#include "files/model_file.h"

namespace edgepose {
namespace {

TaughtTool exact_tool(const WorkCell& cell) {
  TaughtTool tool;
  tool.camera_T_tool = cell.flange_T_camera.inverse() * cell.flange_T_tool;
  tool.residuals.push_back({"not taught: the simulator's truth", 0, 0, {}, 1});
  return tool;
}

ModelHandle service_model(const WorkCell& cell, const std::filesystem::path& file) {
  auto model = std::make_shared<RegisteredModel>();
  model->name = cell.plan.model;
  model->model = load_model(file);
  model->plan = cell.plan;
  return model;
}

}  // namespace

TaughtFile make_goal(const WorkCell& cell, const ToldEquipment& told, const DemoOptions& options,
                     const std::filesystem::path& model_file,
                     const std::function<void(const std::string& progress)>& note) {
  TaughtFile file{utc_now(), cell.plan.model, {}};
  if (options.goal == DemoGoal::kExact) {
    file.taught = exact_tool(cell);
    return file;
  }
  const ExperimentArm five{"taught", GoalKind::kTaughtFive, {}};
  std::string last;
  file.taught = taught_tool(cell, service_model(cell, model_file), told.camera, five, options.seed,
                            options.taught_poses, [&](const std::string& place, int) {
                              note(place == last ? "" : "teaching at " + place);
                              last = place;
                            });
  return file;
}

}  // namespace edgepose
