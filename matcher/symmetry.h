#pragma once
#include "matcher/model_block.h"

namespace edgepose {

/// Rigid motions that map the surface onto itself within 0.01 diameters.
Symmetries find_symmetries(const std::vector<OrientedPoint>& surface, float diameter);

/// Joins found and declared symmetries (declared ones win where both say the same) into `parts`.
void store_symmetries(const Symmetries& found, const Symmetries& declared, ModelParts& parts);

}  // namespace edgepose
