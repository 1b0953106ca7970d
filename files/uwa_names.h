#pragma once
#include <filesystem>
#include <vector>

namespace edgepose {

/// A ground-truth file and the two PLYs that it is about.
struct UwaTruthFile {
  std::filesystem::path truth, model, scene;
};

/// Finds model and scene of each `<object>-<scene>.xf` among `plys`. The scene's PLY is named as in the .xf
/// (case aside). The model's too, or it is the only one that starts so: UWA has "chef" for cheff.ply and
/// "T-rex" for T-rex_high.ply. Of several PLYs with the same name the one in a folder with "model" (or
/// "scene") in its name is meant. Throws InputError that names the .xf if one is missing or remains in doubt.
std::vector<UwaTruthFile> match_uwa_names(const std::vector<std::filesystem::path>& truths,
                                          const std::vector<std::filesystem::path>& plys);

}  // namespace edgepose
