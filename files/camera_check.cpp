#include "files/camera_check.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "files/number_text.h"

namespace edgepose {

void check_camera(const Camera& camera, const std::string& where, std::optional<int> width,
                  std::optional<int> height) {
  // Fields of view of 157 to 0.6 degrees. The centre of a picture cut out of a larger one may lie outside of
  // it.
  constexpr double kShortest = 0.1, kLongest = 100, kFarthest = 10;  // [larger sides of the image]
  constexpr double kLeastUnsized = 1, kMostUnsized = 1e6;            // [pixels] where the size is not known
  const std::optional<double> side =
      width && height ? std::optional<double>(std::max(*width, *height)) : std::nullopt;
  const auto require = [&](const char* name, double value, double low, double high, const char* advice) {
    if (value >= low && value <= high) return;
    throw InputError::at(
        where,
        std::string(name) + " from " + number_text(low) + " to " + number_text(high) +
            (side ? " for an image of " + std::to_string(*width) + " x " + std::to_string(*height) + " pixels"
                  : " pixels"),
        number_text(value), advice);
  };
  const double least = side ? kShortest * *side : kLeastUnsized,
               most = side ? kLongest * *side : kMostUnsized;
  const char* advice = "give the intrinsics of the depth camera: fx, fy, cx, cy in pixels";
  require("fx", camera.fx, least, most, advice);
  require("fy", camera.fy, least, most, advice);
  const double farthest = side ? kFarthest * *side : kMostUnsized;
  require("cx", camera.cx, -farthest, farthest, "the intrinsics belong to another resolution");
  require("cy", camera.cy, -farthest, farthest, "the intrinsics belong to another resolution");
}

std::string off_centre_warning(const Camera& camera, int width, int height) {
  if (camera.cx >= 0 && camera.cx < width && camera.cy >= 0 && camera.cy < height) return "";
  return "the principal point (" + number_text(camera.cx) + ", " + number_text(camera.cy) +
         ") is outside of the image of " + std::to_string(width) + " x " + std::to_string(height) +
         " pixels: right only if that was cut out of a larger one";
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
