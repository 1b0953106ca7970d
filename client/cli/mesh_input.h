#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iosfwd>
#include <string>

#include "files/sound_mesh.h"

namespace edgepose {

/// True for the extensions of mesh and cloud files, unless the content is a trained model.
bool is_mesh_file(const std::filesystem::path& path);

/// What was mended, and what the user should look at; a line each, led by `path`.
void print_notes(std::ostream& out, const std::filesystem::path& path, const MeshHealth& health);

/// Adds --any-size, which takes objects that are too small or large to be likely.
void add_any_size_option(CLI::App& command, bool& any_size);
inline MeshLimits limits_for(bool any_size) { return any_size ? kAnySize : MeshLimits{}; }

/// Adds `option` ("--unit"), mm or m, millimetres by default.
void add_unit_option(CLI::App& command, const std::string& option, LengthUnit& unit,
                     const std::string& of_what);

}  // namespace edgepose
