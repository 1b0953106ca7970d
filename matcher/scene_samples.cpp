#include "matcher/scene_samples.h"

#include <cmath>

namespace edgepose {
namespace {

constexpr float kRungs = 4;  // an octave: grids are at most 9 % wider or narrower than asked for

int rung(float length) { return static_cast<int>(std::lround(kRungs * std::log2(length))); }
float length(int rung) { return std::exp2(static_cast<float>(rung) / kRungs); }

}  // namespace

// The ratio of the two is the same for most models, so diameters need no rung by themselves: rounding step
// and ratio makes each at most half a rung too small.
SampleScale::SampleScale(float step_m, float diameter_m, const SamplingOptions& sampling)
    : step(rung(step_m)), diameter(step + rung(diameter_m / step_m) + 1), options(sampling) {}

float SampleScale::step_size() const { return length(step); }
float SampleScale::most_diameter() const { return length(diameter); }

SampleCache::Entry& SampleCache::entry_for(const SampleScale& scale) {
  const std::lock_guard lock(mutex_);
  for (Entry& entry : entries_)
    if (entry.scale == scale) return entry;
  return entries_.emplace_back(scale);
}

}  // namespace edgepose
