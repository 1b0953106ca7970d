/// edgepose-phantom: writes the phantom, its drill plan and the sample scenes (models/phantom/README.md).
#include <exception>
#include <filesystem>
#include <iostream>
#include <string>

#include "common/error.h"
#include "files/mesh_file.h"
#include "models/phantom/drill_plan.h"
#include "models/phantom/phantom_mesh.h"
#include "models/phantom/phantom_views.h"
#include "models/phantom/sample_files.h"
#include "models/phantom/sample_scenes.h"

namespace edgepose::phantom {
namespace {

namespace fs = std::filesystem;

/// BOP wants the mesh in a place of its own; a link saves a second copy.
void link_mesh(const fs::path& link) {
  fs::create_directories(link.parent_path());
  if (!fs::is_symlink(fs::symlink_status(link))) fs::create_symlink("../../phantom/phantom.ply", link);
}

void generate(const fs::path& folder) {
  fs::create_directories(folder / "phantom");
  const Mesh mesh = phantom_mesh();
  write_ply(folder / "phantom" / "phantom.ply", mesh);
  write_drill_plan(folder / "phantom" / "drill_plan.json", drill_plan(), 1000 * diameter(mesh));
  write_png(folder / "phantom" / "views.png", phantom_views(mesh));

  std::vector<SampleScene> scenes;
  for (int i = 0; i < kSampleScenes; ++i) scenes.push_back(sample_scene(mesh, i));
  write_scene(folder / "phantom" / "scene", scenes.back());
  scenes.pop_back();
  link_mesh(folder / "sample_set" / "models" / "obj_000001.ply");
  write_sample_set(folder / "sample_set", mesh, scenes);
  std::cout << folder.string() << ": phantom of " << mesh.triangles.size() << " triangles, "
            << scenes.size() + 1 << " scenes\n";
}

}  // namespace
}  // namespace edgepose::phantom

int main(int argc, char** argv) {
  if (argc != 2 || argv[1][0] == '-') {
    std::cout
        << "Usage: edgepose-phantom FOLDER\n"
           "Writes FOLDER/phantom (mesh, drill plan, sample scene) and FOLDER/sample_set (BOP layout).\n";
    return argc == 2 && std::string(argv[1]) == "--help" ? 0 : 2;
  }
  try {
    edgepose::phantom::generate(argv[1]);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << "edgepose-phantom: " << error.what() << "\n";
    return 2;
  }
}
