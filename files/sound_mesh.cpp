#include "files/sound_mesh.h"

namespace edgepose {

SoundMesh read_sound_mesh(const std::filesystem::path& path, LengthUnit unit, const MeshLimits& limits) {
  Mesh mesh = read_mesh(path, unit);
  MeshHealth health = check_mesh(mesh, limits);
  mesh = mend_mesh(std::move(mesh), health, path.string());
  return {std::move(mesh), std::move(health)};
}

}  // namespace edgepose
