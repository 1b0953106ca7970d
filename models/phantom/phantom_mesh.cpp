#include "models/phantom/phantom_mesh.h"

#include "models/phantom/phantom_shape.h"
#include "models/phantom/surface_nets.h"

namespace edgepose::phantom {

Mesh phantom_mesh() {
  constexpr double kCell = 1.5;  // mm: 15,000 triangles, 370 kB
  Mesh mesh = surface_nets(signed_distance, outward_normal, kBoxMin, kBoxMax, kCell);
  for (Eigen::Vector3f& vertex : mesh.vertices) vertex *= 0.001f;
  return mesh;
}

}  // namespace edgepose::phantom
