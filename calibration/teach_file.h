#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "servoing/teaching.h"

namespace edgepose {

/// What was recorded for teaching (JSON; docs/servoing.md): for each reference its name, "model_T_tool" and
/// the poses "camera_T_model" measured while the tool stood there. `model`: which one. Throws InputError that
/// names file and member.
struct TeachRecord {
  std::string model;
  std::vector<TaughtReference> references;
};
TeachRecord parse_teach_record(std::string_view text, const std::string& name);
TeachRecord read_teach_record(const std::filesystem::path& path);

/// What was learned, as it is kept: dated, with the residual of each reference. `made`: UTC,
/// 2026-11-23T09:30:00Z.
struct TaughtFile {
  std::string made, model;
  TaughtTool taught;
};
TaughtFile parse_taught(std::string_view text, const std::string& name);
TaughtFile read_taught(const std::filesystem::path& path);
std::string format_taught(const TaughtFile& file);
void write_taught(const std::filesystem::path& path, const TaughtFile& file);

}  // namespace edgepose
