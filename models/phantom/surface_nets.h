#pragma once
#include <Eigen/Core>
#include <functional>

#include "matcher/types.h"

namespace edgepose::phantom {

/// An implicit surface (negative inside) turned into a mesh by surface nets (Gibson 1998): one vertex for
/// each grid cell of edge length `cell` that the surface crosses, one quad (two triangles) for each crossed
/// grid edge. Closed and outward if the surface stays inside the box. Vertices are then moved onto the
/// surface. Coordinates in the unit of the function; normals from `normal`.
Mesh surface_nets(const std::function<double(const Eigen::Vector3d&)>& distance,
                  const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& normal,
                  const Eigen::Vector3d& box_min, const Eigen::Vector3d& box_max, double cell);

}  // namespace edgepose::phantom
