#include "client/cli/mesh_input.h"
#include "common/command_line.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <map>
#include <ostream>

#include "matcher/model_block.h"

namespace edgepose {

bool is_mesh_file(const std::filesystem::path& path) {
  std::array<char, kModelMagic.size()> start{};
  if (std::ifstream(path, std::ios::binary).read(start.data(), start.size()) && start == kModelMagic) {
    return false;
  }
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension == ".ply" || extension == ".stl" || extension == ".obj" || extension == ".pcd";
}

void print_notes(std::ostream& out, const std::filesystem::path& path, const MeshHealth& health) {
  for (const std::string& line : health.mended) out << path.string() << ": mended: " << line << '\n';
  for (const std::string& line : health.warnings) out << path.string() << ": warning: " << line << '\n';
}

void add_any_size_option(CLI::App& command, bool& any_size) {
  command.add_flag("--any-size", any_size,
                   "Take meshes of 1 mm to 100 m; by default 5 mm to 5 m, others are likely in another unit");
}

void add_unit_option(CLI::App& command, const std::string& option, LengthUnit& unit,
                     const std::string& of_what) {
  static const std::map<std::string, LengthUnit> kUnits = {{"mm", LengthUnit::kMillimetre},
                                                           {"m", LengthUnit::kMetre}};
  choose(command.add_option(option, unit, "Unit of " + of_what + ": mm (default) or m"), kUnits);
}

}  // namespace edgepose
