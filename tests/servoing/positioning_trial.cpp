#include "tests/servoing/positioning_trial.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>

#include "servoing/teaching.h"

namespace edgepose {
namespace {

constexpr double kFocal = 504, kCx = 320, kCy = 288;  // Azure Kinect, NFOV unbinned
constexpr double kGain = 0.8;
constexpr int kSteps = 20;

struct Intrinsics {
  double fx = kFocal, fy = kFocal, cx = kCx, cy = kCy;
};

/// Least-squares rigid fit of `to` = T `from` (Arun, Huang and Blostein 1987).
RigidTransform fitted(const std::vector<Eigen::Vector3d>& from, const std::vector<Eigen::Vector3d>& to) {
  Eigen::Vector3d from_mean = Eigen::Vector3d::Zero(), to_mean = Eigen::Vector3d::Zero();
  for (size_t i = 0; i < from.size(); ++i) from_mean += from[i], to_mean += to[i];
  from_mean /= static_cast<double>(from.size());
  to_mean /= static_cast<double>(to.size());
  Eigen::Matrix3d correlation = Eigen::Matrix3d::Zero();
  for (size_t i = 0; i < from.size(); ++i)
    correlation += (to[i] - to_mean) * (from[i] - from_mean).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(correlation, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double side = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  const Eigen::Matrix3d rotation =
      svd.matrixU() * Eigen::Vector3d(1, 1, side).asDiagonal() * svd.matrixV().transpose();
  return rigid_transform(rotation, to_mean - rotation * from_mean);
}

struct World {
  ToldCalibration truth, told;
  Intrinsics told_camera;
  std::vector<Eigen::Vector3d> points;  ///< of the model, which stands at the base's origin

  RigidTransform measured(const RigidTransform& camera_T_model) const {
    std::vector<Eigen::Vector3d> seen;
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d p = camera_T_model * point;
      const double u = kFocal * p.x() / p.z() + kCx, v = kFocal * p.y() / p.z() + kCy;
      seen.emplace_back((u - told_camera.cx) / told_camera.fx * p.z(),
                        (v - told_camera.cy) / told_camera.fy * p.z(), p.z());
    }
    return fitted(points, seen);
  }
};

RigidTransform perturbed(const RigidTransform& truth, double sigma, Draws& draws) {
  const Eigen::Vector3d turn = rotation_vector(truth.linear()) + draws.gauss(sigma);
  return rigid_transform(rotation_matrix(turn), truth.translation() + draws.gauss(sigma));
}

/// The tool at a hole: entry on the front of the model, axis into it, up to 25 degrees from straight.
RigidTransform random_hole(Draws& draws) {
  const Eigen::Vector3d entry = draws.vector(0.025) + Eigen::Vector3d(0, 0, -0.02);
  const Eigen::Vector3d axis = rotation_matrix(draws.within(25 * M_PI / 180)) * Eigen::Vector3d::UnitZ();
  return model_T_tool_goal(entry, axis, 0, RigidTransform::Identity());
}

World make_world(const TrialSetup& setup, Draws& draws) {
  World world;
  world.truth = true_rig(setup.distance);
  world.told.flange_T_camera = perturbed(world.truth.flange_T_camera, setup.noise.calibration, draws);
  world.told.flange_T_tool = perturbed(world.truth.flange_T_tool, setup.noise.calibration, draws);
  const Eigen::Vector3d focal = draws.gauss(setup.noise.focal), centre = draws.gauss(setup.noise.centre);
  world.told_camera = {kFocal + focal.x(), kFocal + focal.y(), kCx + centre.x(), kCy + centre.y()};
  for (int i = 0; i < 60; ++i)
    world.points.emplace_back(draws.between(-0.04, 0.04), draws.between(-0.04, 0.04),
                              draws.between(-0.02, 0.02));
  return world;
}

/// What teaching finds: the tool truly at each reference (but for the error of the touch), 30 poses of each.
RigidTransform taught_tool(const World& world, const std::vector<RigidTransform>& holes,
                           const TrialSetup& setup, Draws& draws) {
  std::vector<TaughtReference> references;
  for (const RigidTransform& hole : holes) {
    const RigidTransform touch = rigid_transform(rotation_matrix(draws.gauss(setup.touch_angle_sigma)),
                                                 draws.gauss(setup.touch_sigma));
    const RigidTransform seen = world.measured(camera_T_model_goal(camera_T_tool(world.truth), hole * touch));
    references.push_back(
        {"reference " + std::to_string(references.size() + 1), hole, std::vector<RigidTransform>(30, seen)});
  }
  TeachingOptions options;
  options.min_references = static_cast<int>(holes.size());
  return teach(references, options).camera_T_tool;
}

/// `share` of the way from where something is to where it shall be.
RigidTransform part(const RigidTransform& now_T_goal, double share) {
  return rigid_transform(rotation_matrix(share * rotation_vector(now_T_goal.linear())),
                         share * now_T_goal.translation());
}

RigidTransform goal_tool(const World& world, const RigidTransform& hole, const TrialSetup& setup,
                         Draws& draws) {
  std::vector<RigidTransform> others;
  for (int i = 0; i < setup.references; ++i) others.push_back(random_hole(draws));
  switch (setup.source) {
    case GoalSource::kOneShot:
    case GoalSource::kCalibrated:
      return camera_T_tool(world.told);
    case GoalSource::kExact:
      return camera_T_tool(camera_T_model_goal(camera_T_tool(world.truth), hole), hole);
    case GoalSource::kTaughtSame:
      return taught_tool(world, {hole}, setup, draws);
    case GoalSource::kTaughtOther:
      return taught_tool(world, others, setup, draws);
  }
  return RigidTransform::Identity();
}

}  // namespace

TrialResult positioning_trial(const TrialSetup& setup, uint64_t seed) {
  Draws draws(seed);
  const World world = make_world(setup, draws);
  const RigidTransform hole = random_hole(draws);
  const RigidTransform start_error = draws.pose(20 * M_PI / 180, 0.1);
  const RigidTransform tool_in_camera = goal_tool(world, hole, setup, draws);
  const RigidTransform goal = camera_T_model_goal(tool_in_camera, hole);
  const RigidTransform& x = world.truth.flange_T_camera;
  // The model stands at the base's origin.
  RigidTransform flange = hole * world.truth.flange_T_tool.inverse() * start_error;
  const auto seen = [&] { return world.measured((flange * x).inverse()); };
  TrialResult result;
  result.steps = kSteps + 1;
  if (setup.source == GoalSource::kOneShot) {
    const RigidTransform goal_in_tool = tool_T_tool_goal(tool_in_camera, seen(), hole);
    flange =
        base_T_tool_goal(flange, world.told.flange_T_tool, goal_in_tool) * world.told.flange_T_tool.inverse();
  } else {
    for (int step = 0; step < kSteps; ++step) {
      const RigidTransform camera_T_goal = seen() * goal.inverse();
      const GoalError left = goal_error(camera_T_goal);
      if (left.translation < 0.0003 && left.rotation < 0.2 * M_PI / 180)
        result.steps = std::min(result.steps, step);
      const RigidTransform& told = world.told.flange_T_camera;
      flange = flange * told * part(camera_T_goal, kGain) * told.inverse();
    }
  }
  result.error = goal_error(hole.inverse() * flange * world.truth.flange_T_tool);
  return result;
}

}  // namespace edgepose
