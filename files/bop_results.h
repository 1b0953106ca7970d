#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "matcher/types.h"

namespace edgepose {

/// One estimated pose: a line of a BOP result file.
struct BopResult {
  int scene_id = 0, image_id = 0, object_id = 0;
  double score = 0;                                            ///< higher is better
  RigidTransform camera_T_model = RigidTransform::Identity();  ///< metres
  double time = -1;  ///< [s] for this object in this image; -1 = not measured
};

/// "scene_id,im_id,obj_id,score,R,t,time" and a line for each result: R row-major and t in millimetres,
/// blanks between values; 9 significant digits.
std::string format_bop_results(const std::vector<BopResult>& results);
void write_bop_results(const std::filesystem::path& path, const std::vector<BopResult>& results);

/// Reads such a file, with or without the header line. Throws InputError that names file and line.
std::vector<BopResult> read_bop_results(const std::filesystem::path& path);
std::vector<BopResult> parse_bop_results(std::string_view text, const std::string& name);

}  // namespace edgepose
