#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace edgepose {

/// A hole to drill, in the model's frame. SI units.
struct DrillTarget {
  std::string name;
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();  ///< [m] where the axis meets the surface
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< unit; the way the drill moves, into the object
  double depth = 0;                                 ///< [m] > 0, from the entry along the axis
  double diameter = 0;                              ///< [m] > 0
  double position_tolerance = 0;                    ///< [m] > 0, of the entry and the bottom, across the axis
  double angle_tolerance = 0;                       ///< [rad] > 0, at most pi / 2, of the axis
};

/// What is to be drilled into one object.
struct DrillPlan {
  std::string model;  ///< name of the trained model
  double model_diameter =
      0;  ///< [m] its largest distance between two points: guards against another model or unit
  std::vector<DrillTarget> targets;
};

/// Reads a plan (JSON in millimetres and degrees, docs/drill_plan.md). Throws InputError that names file and
/// member: no JSON, missing or non-finite values, an axis of length 0, a depth, diameter or tolerance that is
/// not positive, names that are empty or double, no targets, targets farther apart than the model is large.
DrillPlan read_drill_plan(const std::filesystem::path& path);
DrillPlan parse_drill_plan(std::string_view text, const std::string& name);

/// Throws InputError, led by `name`, unless the plan fits the model: the same diameter to 5 % and each hole,
/// entry and bottom, within one diameter of the `centre` [m, model frame].
void check_drill_plan(const DrillPlan& plan, const Eigen::Vector3d& centre, double model_diameter,
                      const std::string& name);

std::string format_drill_plan(const DrillPlan& plan);
void write_drill_plan(const std::filesystem::path& path, const DrillPlan& plan);

}  // namespace edgepose
