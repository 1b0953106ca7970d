#include "matcher/symmetry.h"

namespace edgepose {

void store_symmetries(const Symmetries& found, const Symmetries& declared, ModelParts& parts) {
  const Symmetries& chosen = declared.empty() ? found : declared;
  for (const RigidTransform& t : chosen.discrete)
    for (int i = 0; i < 16; ++i) parts.discrete.push_back(t.matrix()(i / 4, i % 4));
  for (const SymmetryAxis& axis : chosen.continuous)
    for (const Eigen::Vector3d& v : {axis.point, axis.direction})
      for (int i = 0; i < 3; ++i) parts.continuous.push_back(v[i]);
}

Symmetries find_symmetries(const std::vector<OrientedPoint>& surface, float diameter) {
  (void)surface, (void)diameter;
  return {};
}

}  // namespace edgepose
