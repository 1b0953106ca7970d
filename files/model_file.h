#pragma once
#include <filesystem>

#include "matcher/model.h"

namespace edgepose {

/// Writes the model's block, aside and renamed. Programs that have the old file mapped keep the old content.
void save_model(const std::filesystem::path& path, const Model& model);

/// Maps the file read-only and checks it whole (Model::from_block). Throws InputError if it is missing, a
/// folder, unreadable, empty, no model file, of another version, cut short or damaged.
/// The pages are shared with all programs that use the model. The file may be replaced (save_model) but must
/// not be shortened in place while it is in use.
Model load_model(const std::filesystem::path& path);

}  // namespace edgepose
