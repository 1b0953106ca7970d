#include <cmath>

#include "common/error.h"
#include "render/sensor_model.h"

namespace edgepose {

std::string SensorModel::check() const {
  const struct {
    const char* name;
    double value, low, high;
  } fields[] = {
      {"noise", noise, 0, 1},
      {"noise_per_square_metre", noise_per_square_metre, 0, 1},
      {"correlated_share", correlated_share, 0, 1},
      {"correlation_radius", correlation_radius, 0.1, 20},
      {"baseline", baseline, 0, 10},
      {"disparity_noise", disparity_noise, 0, 100},
      {"disparity_step", disparity_step, 0, 100},
      {"jump_threshold", jump_threshold, 0, 10},
      {"flying_pixels", flying_pixels, 0, 1},
      {"jump_dropout", jump_dropout, 0, 1},
      {"dropout", dropout, 0, 1},
      {"fading_angle_deg", fading_angle_deg, 0, blind_angle_deg},
      {"blind_angle_deg", blind_angle_deg, 0, 90},
      {"min_depth", min_depth, 0, max_depth},
      {"max_depth", max_depth, 0, 1e4},
      {"depth_step", depth_step, 0, 1},
  };
  for (const auto& field : fields) {
    if (!(field.value >= field.low && field.value <= field.high)) {  // also catches NaN
      return std::string("SensorModel.") + field.name + ": expected a value in [" +
             std::to_string(field.low) + ", " + std::to_string(field.high) + "], found " +
             std::to_string(field.value);
    }
  }
  if (baseline == 0 && (disparity_noise > 0 || disparity_step > 0)) {
    return "SensorModel.baseline: expected a positive value beside disparity_noise or disparity_step, found "
           "0";
  }
  return {};
}

SensorModel SensorModel::ideal() { return {}; }

SensorModel SensorModel::laser() {
  SensorModel sensor;
  sensor.noise = 0.25e-3;
  sensor.blind_angle_deg = 88;
  sensor.fading_angle_deg = 80;
  sensor.depth_step = 0.1e-3;
  return sensor;
}

// After the first Kinect and its like (Khoshelham and Oude Elberink 2012): disparity in steps of 1/8 pixel.
SensorModel SensorModel::structured_light() {
  SensorModel sensor;
  sensor.baseline = 0.075;
  sensor.disparity_noise = 0.08;
  sensor.disparity_step = 0.125;
  sensor.correlated_share = 0.7;
  sensor.correlation_radius = 1.5;
  sensor.jump_dropout = 0.5;
  sensor.fading_angle_deg = 65;
  sensor.blind_angle_deg = 82;
  sensor.min_depth = 0.3;
  sensor.max_depth = 5;
  return sensor;
}

// After measurements of the Azure Kinect (Kurillo et al. 2022; Toelgyessy et al. 2021).
SensorModel SensorModel::time_of_flight() {
  SensorModel sensor;
  sensor.noise = 0.7e-3;
  sensor.noise_per_square_metre = 0.6e-3;
  sensor.correlated_share = 0.7;
  sensor.correlation_radius = 1.2;
  sensor.flying_pixels = 0.3;
  sensor.jump_dropout = 0.25;
  sensor.dropout = 0.001;
  sensor.fading_angle_deg = 75;
  sensor.blind_angle_deg = 87;
  sensor.min_depth = 0.25;
  sensor.max_depth = 5.5;
  sensor.depth_step = 1e-3;
  return sensor;
}

SensorModel SensorModel::named(const std::string& name) {
  if (name == "ideal") return ideal();
  if (name == "laser") return laser();
  if (name == "structured_light") return structured_light();
  if (name == "time_of_flight") return time_of_flight();
  throw InputError::at("sensor", "ideal, laser, structured_light or time_of_flight", "'" + name + "'");
}

}  // namespace edgepose
