#pragma once
#include <filesystem>

#include "files/mesh_file.h"
#include "files/mesh_health.h"

namespace edgepose {

/// A mesh or cloud as it can be trained, and what was found and mended on the way.
struct SoundMesh {
  Mesh mesh;
  MeshHealth health;
};

/// Reads, checks and mends. Throws InputError where it cannot be mended.
SoundMesh read_sound_mesh(const std::filesystem::path& path, LengthUnit unit, const MeshLimits& limits = {});

}  // namespace edgepose
