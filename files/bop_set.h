#pragma once
#include "files/test_set.h"

namespace edgepose {

/// Whether `folder` is laid out as BOP sets are: it has models/models_info.json.
bool looks_like_bop(const std::filesystem::path& folder);

/// Reads models/models_info.json and every scene in test/ (each folder with a scene_camera.json). Throws
/// InputError that names the file if one is missing or damaged, or if they contradict each other.
TestSet read_bop_set(const std::filesystem::path& folder);

}  // namespace edgepose
