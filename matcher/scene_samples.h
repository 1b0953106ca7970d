#pragma once
#include <list>
#include <mutex>
#include <vector>

#include "matcher/match_options.h"
#include "matcher/sampled_point.h"

namespace edgepose {

/// What a scene is sampled for: lengths on a ladder of four rungs an octave, so that models of like size
/// share the samples.
struct SampleScale {
  int step;      ///< rung of the grid's cells
  int diameter;  ///< rung that the diameters of these models do not exceed
  SamplingOptions options;

  /// `step`, `diameter` [m], positive.
  SampleScale(float step, float diameter, const SamplingOptions& options);
  float step_size() const;      ///< [m]
  float most_diameter() const;  ///< [m]
  bool operator==(const SampleScale&) const = default;
};

/// A scene, sampled for one scale.
struct SceneSamples {
  std::vector<SampledPoint> fine;     ///< one grid for all
  std::vector<SampledPoint> thinned;  ///< twice as wide where the surface is even; empty if there is no need
};

/// The samples of one scene: made when they are asked for, and kept. Safe from any thread.
class SampleCache {
 public:
  /// What `make` returns for the scale; called once, also if several threads ask at the same time.
  template <typename Make>
  const SceneSamples& get(const SampleScale& scale, const Make& make) {
    Entry& entry = entry_for(scale);
    std::call_once(entry.made, [&] { entry.samples = make(); });
    return entry.samples;
  }

 private:
  struct Entry {
    explicit Entry(const SampleScale& of) : scale(of) {}
    SampleScale scale;
    std::once_flag made;
    SceneSamples samples;
  };
  Entry& entry_for(const SampleScale& scale);

  std::mutex mutex_;
  std::list<Entry> entries_;  // stay where they are
};

}  // namespace edgepose
