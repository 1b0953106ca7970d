#include "files/test_set.h"

#include "common/error.h"
#include "files/bop_set.h"
#include "files/uwa_set.h"

namespace edgepose {

TestSet read_test_set(const std::filesystem::path& folder) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw InputError::at(folder.string(), "the folder of a test set",
                         std::filesystem::exists(folder, ignored) ? "a file" : "no such folder");
  if (looks_like_bop(folder)) return read_bop_set(folder);
  if (looks_like_uwa(folder)) return read_uwa_set(folder);
  throw InputError::at(
      folder.string(),
      "a test set: BOP's layout (models/models_info.json, models/obj_NNNNNN.ply and in "
      "test/NNNNNN/ scene_camera.json, scene_gt.json, depth/NNNNNN.png) or UWA's (PLYs of models "
      "and scenes with <object>-<scene>.xf files)",
      "neither models/models_info.json nor any .xf file",
      "give the folder that holds models/ and test/, or the one that holds the .xf files");
}

std::string folder_name(const std::filesystem::path& folder) {
  std::error_code error;
  const std::filesystem::path whole = std::filesystem::canonical(folder, error);
  return (error ? folder : whole).filename().string();
}

}  // namespace edgepose
