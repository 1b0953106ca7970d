#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <iosfwd>
#include <string>

#include "files/mesh_file.h"
#include "files/mesh_health.h"

namespace edgepose {

/// A mesh or cloud as it can be trained, and what was found and mended on the way.
struct SoundMesh {
  Mesh mesh;
  MeshHealth health;
};

/// Reads, checks and mends. Throws InputError where it cannot be mended.
SoundMesh read_sound_mesh(const std::filesystem::path& path, LengthUnit unit);

/// True for the extensions of mesh and cloud files, unless the content is a trained model.
bool is_mesh_file(const std::filesystem::path& path);

/// What was mended, and what the user should look at; a line each, led by `path`.
void print_notes(std::ostream& out, const std::filesystem::path& path, const MeshHealth& health);

/// Adds `option` ("--unit"), mm or m, millimetres by default.
void add_unit_option(CLI::App& command, const std::string& option, LengthUnit& unit,
                     const std::string& of_what);

}  // namespace edgepose
