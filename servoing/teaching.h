#pragma once
#include <string>
#include <vector>

#include "servoing/pose_mean.h"

namespace edgepose {

/// One known place of the model that the tool was brought to, and how the camera saw the model meanwhile.
struct TaughtReference {
  std::string name;
  RigidTransform model_T_tool = RigidTransform::Identity();  ///< of the tool while it stood there
  std::vector<RigidTransform> camera_T_model;                ///< measured, the arm at rest
};

struct TeachingOptions {
  int min_references = 5;                 ///< fewer leave the measurement's error at that place in the result
  int min_poses = 30;                     ///< of each reference; the noise of the mean falls with their root
  double max_translation_spread = 0.002;  ///< [m] of a reference's poses: more, and something moved
  double max_rotation_spread = 0.02;      ///< [rad] likewise
  double max_disagreement = 0.01;  ///< [m] of one reference's tip from the mean of all: more is a mix-up ...
  double max_turn = 0.1;           ///< [rad] ... likewise

  std::string check() const;
};

/// Where the camera sees the tool, learned.
struct TaughtTool {
  struct Residual {
    std::string name;
    double translation = 0;  ///< [m] of the tip, this reference alone against all
    double rotation = 0;     ///< [rad]
    PoseSpread noise;        ///< of its poses
    int poses = 0;
  };
  RigidTransform camera_T_tool = RigidTransform::Identity();
  std::vector<Residual> residuals;
};

/// Learns Z = T_s^c(measured) T_t^s(reference) = camera_T_tool as the camera measures, its own errors
/// included: poses are averaged for each reference, then the references. A goal is then
/// camera_T_model_goal(Z, plan), in which neither hand-eye nor tool calibration appears. Throws InputError
/// that names the reference: too few, poses that are not proper or too far apart, a reference that
/// contradicts the others.
TaughtTool teach(const std::vector<TaughtReference>& references, const TeachingOptions& options = {});

}  // namespace edgepose
