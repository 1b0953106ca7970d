#pragma once
#include <cstdint>
#include <string>

#include "matcher/types.h"

namespace edgepose {

/// How a depth camera spoils the true depth. Each effect is off at its default; the presets switch on what a
/// kind of sensor is known for. Lengths in metres.
struct SensorModel {
  // Noise along the viewing ray: sigma(z) = noise + noise_per_square_metre * z^2.
  double noise = 0;                   ///< [m]
  double noise_per_square_metre = 0;  ///< [m / m^2]
  double correlated_share = 0;      ///< [0, 1] share of the variance that neighbouring pixels have in common
  double correlation_radius = 1.5;  ///< [pixels] Gaussian radius over which they have it in common

  // Triangulation: the camera measures disparity fx * baseline / z. 0 = the sensor does not triangulate.
  double baseline = 0;  ///< [m] the projector stands this far to the right; what it does not light is a hole
  double disparity_noise = 0;  ///< [pixels] sigma; shares `correlated_share` with the noise above
  double disparity_step = 0;   ///< [pixels] quantisation of the disparity; 0 = none

  // Depth jumps: neighbours that differ by more than jump_threshold * z.
  double jump_threshold = 0.02;  ///< [m / m]
  double flying_pixels = 0;      ///< [0, 1] chance of a depth somewhere between the two sides
  double jump_dropout = 0;       ///< [0, 1] chance of a hole

  // Holes elsewhere.
  double dropout = 0;            ///< [0, 1] chance of a hole in any pixel
  double fading_angle_deg = 90;  ///< [degrees] angle between ray and normal at which holes begin ...
  double blind_angle_deg = 90;   ///< [degrees] ... and above which there is nothing but holes
  double min_depth = 0, max_depth = 65.0;  ///< [m] nothing is measured outside

  double depth_step = 0;  ///< [m] quantisation of the depth; 0 = none

  /// Empty if sound, else one line that names the bad field.
  std::string check() const;

  static SensorModel ideal();  ///< the true depth
  static SensorModel laser();  ///< triangulating laser scanner: 0.25 mm noise, 0.1 mm steps
  static SensorModel
  structured_light();  ///< pattern projector: disparity steps, error growing with z^2, shadows
  static SensorModel
  time_of_flight();  ///< like an Azure Kinect: 1 mm correlated noise, flying pixels, whole mm
  /// The preset of that name ("ideal", "laser", "structured_light", "time_of_flight"). Throws InputError.
  static SensorModel named(const std::string& name);
};

/// The depth image that `sensor` would give where a perfect one gives `ideal`. The same seed gives the same
/// bits at any number of threads (0 = all cores). Throws std::invalid_argument if model, camera or image is
/// unsound.
DepthImage apply_sensor(const DepthImage& ideal, const Camera& camera, const SensorModel& sensor,
                        uint64_t seed, int threads = 0);

/// Moves every measured point along its viewing ray by a normally distributed distance of standard deviation
/// `sigma` metres (the paper's noise study). A point that would fall behind the camera becomes a hole.
DepthImage add_gaussian_noise(const DepthImage& image, const Camera& camera, double sigma, uint64_t seed,
                              int threads = 0);

}  // namespace edgepose
