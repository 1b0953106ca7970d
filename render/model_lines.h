#pragma once
#include <vector>

#include "matcher/types.h"

namespace edgepose::internal {

/// A short straight piece of a line on a model, in the frame of `viewpoint`.
struct LinePiece {
  Eigen::Vector3d from, to;
};

/// The lines by which a person knows an object: open borders, creases sharper than `crease_angle` (radians)
/// and the occluding contour seen from `viewpoint` (model frame), found where the interpolated normal turns
/// away (Hertzmann 1999), so that it runs smoothly across a mesh. Hidden lines are included.
std::vector<LinePiece> model_lines(const Mesh& mesh, const Eigen::Vector3d& viewpoint, double crease_angle);

}  // namespace edgepose::internal
