#pragma once
#include <optional>
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// Throws InputError, led by `where`, if a value is missing (0), negative, NaN or absurd, or if the principal
/// point lies outside of an image of the given size.
void check_camera(const Camera& camera, const std::string& where, std::optional<int> width = {},
                  std::optional<int> height = {});

/// From a row-major 3 x 3 matrix [fx 0 cx; 0 fy cy; 0 0 1]; throws InputError for any other shape.
Camera camera_from_matrix(const std::vector<double>& matrix, const std::string& where);

}  // namespace edgepose
