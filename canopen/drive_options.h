#pragma once
#include <cstdint>
#include <string>

#include "canopen/joint_scale.h"

namespace edgepose {

/// What a drive says it is (object 1018).
struct DriveIdentity {
  uint32_t vendor = 0x0000'0ed9, product = 0x0000'0402, revision = 0x0001'0000, serial = 0;
};

/// A simulated drive.
struct DriveOptions {
  int node = 1;  ///< 1 to 127
  DriveIdentity identity;
  std::string name = "edgepose simulated drive";  ///< object 1008
  JointScale scale;
  double position = 0;             ///< [rad] at first
  double lag = 0.004;              ///< [s] time constant with which the axis follows the demanded position
  double sag = 0;                  ///< [rad] that the axis rests beside its demand: gravity, friction
  double brake_deceleration = 50;  ///< [rad/s^2] of the holding brake, without power
};

}  // namespace edgepose
