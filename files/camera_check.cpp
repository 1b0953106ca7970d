#include "files/camera_check.h"

#include <cmath>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "files/number_text.h"

namespace edgepose {

void check_camera(const Camera& camera, const std::string& where, std::optional<int> width,
                  std::optional<int> height) {
  constexpr double kMost = 1e6;  // pixels
  const std::pair<const char*, double> values[] = {
      {"fx", camera.fx}, {"fy", camera.fy}, {"cx", camera.cx}, {"cy", camera.cy}};
  for (const auto& [name, value] : values)
    if (!(value > 0 && value <= kMost))
      throw InputError::at(where, std::string(name) + " above 0 and at most 1e6 pixels", number_text(value),
                           "give the intrinsics of the depth camera: fx, fy, cx, cy in pixels");
  using Centre = std::tuple<const char*, double, std::optional<int>>;
  for (const auto& [name, value, size] : {Centre{"cx", camera.cx, width}, Centre{"cy", camera.cy, height}})
    if (size && value >= *size)
      throw InputError::at(where,
                           std::string(name) + " inside the image of " + std::to_string(*size) + " pixels",
                           number_text(value), "the intrinsics belong to another resolution");
}

Camera camera_from_matrix(const std::vector<double>& matrix, const std::string& where) {
  const std::string expected = "a camera matrix, row by row: fx 0 cx 0 fy cy 0 0 1";
  if (matrix.size() != 9) throw InputError::at(where, expected, std::to_string(matrix.size()) + " values");
  const auto is = [&](size_t at, double value) { return std::abs(matrix[at] - value) < 1e-9; };
  if (!is(3, 0) || !is(6, 0) || !is(7, 0) || !is(8, 1)) {
    const bool transposed = is(1, 0) && is(2, 0) && is(5, 0) && is(8, 1);
    throw InputError::at(where, expected, transposed ? "its transpose, column by column" : "other values");
  }
  // A skew of a fraction of a pixel comes out of some calibrations; more is no depth camera.
  if (!(std::abs(matrix[1]) <= 1.0))
    throw InputError::at(where, expected, "a skew of " + number_text(matrix[1]) + " pixels");
  return Camera{matrix[0], matrix[4], matrix[2], matrix[5]};
}

}  // namespace edgepose
