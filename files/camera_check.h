#pragma once
#include <optional>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// Throws InputError, led by `where`, if a value is NaN or absurd: a focal length that is missing (0),
/// negative, or not between a tenth and a hundred times the image's side, a principal point ten sides away.
void check_camera(const Camera& camera, const std::string& where, std::optional<int> width = {},
                  std::optional<int> height = {});

/// For the user, if the principal point is outside of the image; else empty.
std::string off_centre_warning(const Camera& camera, int width, int height);

/// From a row-major 3 x 3 matrix [fx 0 cx; 0 fy cy; 0 0 1]; throws InputError for any other shape.
Camera camera_from_matrix(const std::vector<double>& matrix, const std::string& where);

}  // namespace edgepose
