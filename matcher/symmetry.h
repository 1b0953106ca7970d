#pragma once
#include "matcher/model_block.h"

namespace edgepose {

/// The rotations that map the surface onto itself: within 0.005 diameters along the normals on average, and
/// but for 1 % of it within 0.02. Turns by less than 15 degrees count only where any turn will do. `samples`
/// of it 0.018 diameters apart, every prefix evenly spread; `crowd`: many points in proportion to area.
Symmetries find_symmetries(const std::vector<OrientedPoint>& samples, const std::vector<OrientedPoint>& crowd,
                           float diameter);

void store_symmetries(const Symmetries& symmetries, ModelParts& parts);

}  // namespace edgepose
