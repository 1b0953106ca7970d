#pragma once
#include <filesystem>
#include <vector>

#include "messaging/depth_message.h"

namespace edgepose::test {

/// A frame of the phantom, and where it truly is.
struct TrueFrame {
  DepthFrame depth;
  RigidTransform camera_T_model;
};

/// The phantom on a table, seen by a hand-held depth camera (320 x 288 pixels, 1 mm noise): `count` frames of
/// a smooth motion, up to `speed` metres (and 3 times as many radians) from one to the next.
std::vector<TrueFrame> moving_phantom(int count, double speed = 0.002);

/// models/phantom/NAME in the sources.
std::filesystem::path phantom_file(const std::string& name);

/// [m] between the model's centre here and there.
double distance(const RigidTransform& a, const RigidTransform& b, const Eigen::Vector3d& centre);

}  // namespace edgepose::test
