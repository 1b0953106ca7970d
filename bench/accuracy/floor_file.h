#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <string>

namespace edgepose::bench {

/// What a set gave: answers to every object that the ground truth lists, accepted or not.
struct SetCount {
  size_t instances = 0;
  std::array<size_t, 2> correct{};  ///< at 0.05 and 0.10 d
};

/// By the set's name.
using SetCounts = std::map<std::string, SetCount>;

/// "set,instances,correct_005,correct_010", a line a set. Throws InputError that names file and line.
SetCounts read_floor(const std::filesystem::path& file);
std::string format_floor(const SetCounts& counts);

/// A set may lose this many: the machine's arithmetic decides about a pose at the very limit.
inline constexpr size_t kMayLose = 1;

/// A set beside its floor.
struct Verdict {
  bool passed = true;
  std::string text;  ///< "kept", "LOST 3 at 0.05 d", ...
};
Verdict judge(const SetCount& floor, const SetCount& now);

}  // namespace edgepose::bench
