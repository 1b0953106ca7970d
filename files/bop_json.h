#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "files/test_set.h"

/// The JSON files of a BOP set, from memory. `name` stands in messages. All throw InputError. Lengths are
/// converted from the files' millimetres to metres.
namespace edgepose {

struct BopCamera {
  Camera camera;
  double depth_scale = 0.001;  ///< [m] per unit
};

/// models_info.json: id, diameter, name ("obj_NNNNNN" if it has none), symmetries; `mesh` stays empty.
std::vector<TestObject> parse_bop_objects(std::string_view text, const std::string& name);

/// scene_camera.json, by image.
std::map<int, BopCamera> parse_bop_cameras(std::string_view text, const std::string& name);

/// scene_gt.json, by image.
std::map<int, std::vector<GroundTruth>> parse_bop_truth(std::string_view text, const std::string& name);

/// scene_gt_info.json: adds what is visible to `truth`; instances must be as many as there.
void add_bop_visibility(std::string_view text, const std::string& name,
                        std::map<int, std::vector<GroundTruth>>& truth);

}  // namespace edgepose
