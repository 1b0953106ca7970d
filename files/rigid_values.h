#pragma once
#include <string>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// Farther than this from the origin nothing is believed, metres: somebody mixed up units, or worse.
inline constexpr double kMaxTranslation = 1000.0;

/// A rigid transform from numbers of a file: `rotation` 9 values row by row, `translation_mm` 3 values in
/// millimetres. Rounding errors of the file are mended (nearest rotation); throws InputError, led by `where`,
/// if the values are not finite or no rotation (scaled, mirrored, skewed).
RigidTransform rigid_from_row_major(const std::vector<double>& rotation,
                                    const std::vector<double>& translation_mm, const std::string& where);

/// The same from a row-major 4 x 4 matrix with millimetres in its last column; the last row must be 0 0 0 1.
RigidTransform rigid_from_matrix(const std::vector<double>& matrix, const std::string& where);

}  // namespace edgepose
