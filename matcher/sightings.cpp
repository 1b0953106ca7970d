#include "matcher/sightings.h"

#include <algorithm>
#include <cmath>

namespace edgepose {

int expected_rounds(int sightings, size_t looked, int batch, size_t references) {
  constexpr float kRound = 75, kFewest = 600, kMost = 900;  // references
  const float all = std::clamp(static_cast<float>(references), kFewest, kMost),
              size = static_cast<float>(batch);
  const auto seen = static_cast<float>(sightings), done = static_cast<float>(looked);
  const float batches = std::max(done, std::ceil(all / size));
  // Laplace's rule of succession for the batches that were not looked at.
  const float rate = std::min(1.f, (seen + (batches - done) * seen / (done + 1)) / batches);
  const float rounds = std::ceil(all / kRound) * (1 - std::pow(1 - rate, kRound / size));
  return std::max(1, static_cast<int>(std::lround(rounds)));
}

}  // namespace edgepose
