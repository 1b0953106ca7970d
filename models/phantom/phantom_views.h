#pragma once
#include "render/overlay.h"

namespace edgepose::phantom {

/// Six noise-free views in two rows: from the back, the front, the left; obliquely, from the head, obliquely.
RgbImage phantom_views(const Mesh& mesh);

}  // namespace edgepose::phantom
