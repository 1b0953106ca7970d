#pragma once
#include <string>
#include <string_view>

#include "files/test_set.h"

namespace edgepose {

/// Whether there is an .xf file in `folder` or up to three levels below it.
bool looks_like_uwa(const std::filesystem::path& folder);

/// Reads UWA's own layout: PLYs of models and scenes in millimetres and ground truth <object>-<scene>.xf, all
/// in one folder or in sub-folders (at most three levels deep). The names of the .xf files tell which PLY is
/// what (files/uwa_names.h); PLYs that none names are left out, because nothing is known of them. Objects are
/// numbered from 1 in the order of their names; images by the number that the scene's name ends with (rs12 ->
/// 12), or from 1 if there is none; all in scene 1. Throws InputError that names the file.
TestSet read_uwa_set(const std::filesystem::path& folder);

/// An .xf file: a row-major 4 x 4 matrix in millimetres, from model to scene.
RigidTransform parse_xf(std::string_view text, const std::string& name);

}  // namespace edgepose
