#include "demo/demo_options.h"

#include "common/error.h"
#include "matcher/option_range.h"

namespace edgepose {

std::string DemoOptions::check() const {
  if (cell.model.empty() != cell.plan.empty())
    return "expected --mesh and --plan together, found only --" +
           std::string(cell.model.empty() ? "plan" : "mesh");
  if (cell.model.empty())
    return "expected --mesh and --plan, found neither, nor the phantom beside the programs; give a mesh and "
           "its drill plan (models/phantom of the sources has both)";
  if (const std::string fault = cell.check(); !fault.empty()) return fault;
  return option_fault({{"taught-poses", static_cast<double>(taught_poses), 1, 1000},
                       {"seconds", seconds, 1, 3600},
                       {"frame_rate", frame_rate, 1, 30},
                       {"start_seconds", start_seconds, 1, 600}});
}

std::filesystem::path program_folder() {
  std::error_code fault;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", fault);
  if (fault) throw InputError::at("/proc/self/exe", "a link to this program", fault.message());
  return self.parent_path();
}

std::filesystem::path phantom_folder() {
  const std::filesystem::path programs = program_folder();
  // PREFIX/bin and PREFIX/share; or build/release/bin of the sources.
  for (const char* place : {"../share/edgepose/phantom", "../../../models/phantom"}) {
    const std::filesystem::path folder = (programs / place).lexically_normal();
    std::error_code ignored;
    if (std::filesystem::is_regular_file(folder / "phantom.ply", ignored) &&
        std::filesystem::is_regular_file(folder / "drill_plan.json", ignored))
      return folder;
  }
  return {};
}

}  // namespace edgepose
