#pragma once
#include "matcher/match.h"

namespace edgepose {

/// What matching one model costs on this machine, and in what image that was measured.
struct ExpectedTime {
  double preprocessing = 0;  ///< [s] once per image
  double matching = 0;       ///< [s] once per model and image
  double total() const { return preprocessing + matching; }
};

/// Matches `model` in a made-up 640x480 image: the object, a third of the image high, before a wall. The
/// median of three runs. Clutter adds scene points, and with them time: take it as the lower end.
ExpectedTime measure_expected_time(const Model& model, int threads = 0);

}  // namespace edgepose
