#pragma once
#include <string>

#include "files/test_set.h"
#include "matcher/scene.h"

namespace edgepose {

/// What an image of a test set shows: a depth image, or a cloud projected to one.
struct ImageInput {
  DepthImage depth;
  Camera camera;
  RigidTransform truth_T_camera = RigidTransform::Identity();  ///< into the frame of the ground truth
  double seconds = 0;                                          ///< wall time that the projection took
  std::string file;
};

/// Throws InputError that names the file.
ImageInput read_image_input(const TestImage& image);

}  // namespace edgepose
