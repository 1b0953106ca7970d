#pragma once
#include <vector>

#include "matcher/types.h"

namespace edgepose::phantom {

/// The camera of all samples: 640 x 576 as the Azure Kinect's narrow field of view.
inline constexpr Camera kSampleCamera{504, 504, 319.5, 287.5};
inline constexpr int kSampleWidth = 640, kSampleHeight = 576;

/// A depth image of the phantom among other things, and the truth about it. Metres.
struct SampleScene {
  DepthImage depth;
  RigidTransform camera_T_model;
  int pixels_alone = 0;    ///< that the phantom would cover if nothing hid it
  int pixels_visible = 0;  ///< that it does cover
  double occlusion = 0;    ///< 1 - visible surface area / whole surface area (Mian's measure)
};

/// How many different scenes there are.
inline constexpr int kSampleScenes = 7;

/// Scene `index`: 0, 3 far and lightly covered; 1, 4 and 6 near, under tissue and instruments; 2, 5 any pose
/// in clutter. Time-of-flight noise. `phantom` in metres.
SampleScene sample_scene(const Mesh& phantom, int index);

}  // namespace edgepose::phantom
