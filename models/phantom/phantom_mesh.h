#pragma once
#include "matcher/types.h"

namespace edgepose::phantom {

/// The phantom's mesh as it is shipped: metres, closed, outward normals.
Mesh phantom_mesh();

}  // namespace edgepose::phantom
