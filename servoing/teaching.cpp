#include "servoing/teaching.h"

#include <sstream>

#include "arm/rigid_motion.h"
#include "common/error.h"
#include "matcher/option_range.h"
#include "servoing/proper_pose.h"

namespace edgepose {
namespace {

std::string in_words(double translation, double rotation) {
  std::ostringstream text;
  text.precision(3);
  text << translation * 1e3 << " mm and " << rotation * 57.29577951308232 << " degrees";
  return text.str();
}

TaughtTool::Residual noise_of(const TaughtReference& reference, const RigidTransform& mean,
                              const TeachingOptions& options) {
  const PoseSpread noise = spread(reference.camera_T_model, mean);
  if (!(noise.translation <= options.max_translation_spread && noise.rotation <= options.max_rotation_spread))
    throw InputError::at("reference " + reference.name,
                         "poses that scatter by at most " +
                             in_words(options.max_translation_spread, options.max_rotation_spread),
                         in_words(noise.translation, noise.rotation), "keep arm and model at rest");
  return {reference.name, 0, 0, noise, static_cast<int>(reference.camera_T_model.size())};
}

void check_reference(const TaughtReference& reference, const TeachingOptions& options) {
  const std::string where = "reference " + reference.name;
  const size_t count = reference.camera_T_model.size();
  if (count < static_cast<size_t>(options.min_poses))
    throw InputError::at(where, "at least " + std::to_string(options.min_poses) + " poses",
                         std::to_string(count));
  if (!is_proper(reference.model_T_tool)) throw InputError::at(where, "a rigid pose of the tool", "another");
  for (const RigidTransform& pose : reference.camera_T_model)
    if (!is_proper(pose)) throw InputError::at(where, "rigid poses of the model", "another");
}

}  // namespace

std::string TeachingOptions::check() const {
  return option_fault({{"min_references", static_cast<double>(min_references), 1, 1000},
                       {"min_poses", static_cast<double>(min_poses), 1, 1e6},
                       {"max_translation_spread", max_translation_spread, 1e-6, 0.1},
                       {"max_rotation_spread", max_rotation_spread, 1e-6, 0.5},
                       {"max_disagreement", max_disagreement, 1e-6, 0.5},
                       {"max_turn", max_turn, 1e-6, 0.5}});
}

TaughtTool teach(const std::vector<TaughtReference>& references, const TeachingOptions& options) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("teaching." + fault);
  if (references.size() < static_cast<size_t>(options.min_references))
    throw InputError::at("teaching", "at least " + std::to_string(options.min_references) + " references",
                         std::to_string(references.size()));
  TaughtTool taught;
  std::vector<RigidTransform> tools;
  for (const TaughtReference& reference : references) {
    check_reference(reference, options);
    const RigidTransform camera_T_model = mean_pose(reference.camera_T_model);
    taught.residuals.push_back(noise_of(reference, camera_T_model, options));
    tools.push_back(camera_T_model * reference.model_T_tool);
  }
  taught.camera_T_tool = mean_pose(tools);
  for (size_t i = 0; i < tools.size(); ++i) {
    const RigidTransform difference = taught.camera_T_tool.inverse() * tools[i];
    TaughtTool::Residual& residual = taught.residuals[i];
    residual.translation = difference.translation().norm();
    residual.rotation = rotation_angle(difference);
    if (!(residual.translation <= options.max_disagreement && residual.rotation <= options.max_turn))
      throw InputError::at("reference " + residual.name,
                           "a tool within " + in_words(options.max_disagreement, options.max_turn) +
                               " of the mean of all references",
                           in_words(residual.translation, residual.rotation), "was the right place touched?");
  }
  return taught;
}

}  // namespace edgepose
