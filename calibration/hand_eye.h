#pragma once
#include <string>
#include <vector>

#include "servoing/pose_mean.h"

namespace edgepose {

/// The arm at rest, and a target that stays in place seen by the camera on its flange.
struct HandEyeSample {
  RigidTransform base_T_flange = RigidTransform::Identity();
  RigidTransform camera_T_target = RigidTransform::Identity();
};

/// How far the target, as placed by one sample or all, seems to have moved; 0 for perfect samples.
struct HandEyeResidual {
  double translation = 0;  ///< [m]
  double rotation = 0;     ///< [rad]
};

struct HandEye {
  RigidTransform flange_T_camera = RigidTransform::Identity();
  std::string method;          ///< the one that explains the samples best, of those that OpenCV has
  HandEyeResidual rms, worst;  ///< over the samples
  std::vector<HandEyeResidual> residuals;  ///< one a sample, in their order
};

struct HandEyeOptions {
  int min_samples = 5;         ///< the error falls with the root of their number; 15 to 20 are good
  double min_turn = 0.17;      ///< [rad] that the flange must turn about two different axes, root mean square
  double max_residual = 0.01;  ///< [m] root mean square; more, and samples contradict each other ...
  double max_turn_residual = 0.05;  ///< [rad] ... likewise

  std::string check() const;
};

/// Where the camera is on the flange (AX = XB), by each of OpenCV's methods (Tsai and Lenz 1989, Park and
/// Martin 1994, Horaud and Dornaika 1995, Andreff 1999, Daniilidis 1998); the one with the smallest residual
/// is taken. Throws InputError: too few samples, poses that are not proper, a flange that turned too little
/// or about one axis only (then the camera's place along that axis is not determined), residuals too large.
HandEye solve_hand_eye(const std::vector<HandEyeSample>& samples, const HandEyeOptions& options = {});

}  // namespace edgepose
