#include "bench/accuracy/floor_file.h"

#include <charconv>
#include <sstream>
#include <vector>

#include "common/error.h"
#include "files/whole_file.h"

namespace edgepose::bench {
namespace {

constexpr const char* kHeader = "set,instances,correct_005,correct_010";

/// The cells of a line; a line end of Windows is left out.
std::vector<std::string> cells_of(std::string line) {
  if (line.ends_with('\r')) line.pop_back();
  std::vector<std::string> cells;
  std::istringstream rest(line);
  for (std::string cell; std::getline(rest, cell, ',');) cells.push_back(cell);
  return cells;
}

size_t count_from(const std::string& cell, const std::string& where) {
  size_t value = 0;
  const char* end = cell.data() + cell.size();
  const auto [stop, failure] = std::from_chars(cell.data(), end, value);
  if (failure != std::errc() || stop != end || cell.empty())
    throw InputError::at(where, "a count", "'" + cell.substr(0, 40) + "'");
  return value;
}

}  // namespace

SetCounts read_floor(const std::filesystem::path& file) {
  constexpr size_t kMaxBytes = 1u << 20;
  std::istringstream text(read_whole_file(file, "counts of poses by set", kMaxBytes));
  SetCounts counts;
  std::string line;
  for (int number = 1; std::getline(text, line); ++number) {
    const std::string where = file.string() + ":" + std::to_string(number);
    const std::vector<std::string> cells = cells_of(line);
    if (number == 1) {
      if (cells != cells_of(kHeader)) throw InputError::at(where, kHeader, "'" + line.substr(0, 80) + "'");
      continue;
    }
    if (cells.empty()) continue;
    if (cells.size() != 4) throw InputError::at(where, "4 cells", std::to_string(cells.size()));
    SetCount count;
    count.instances = count_from(cells[1], where);
    count.correct = {count_from(cells[2], where), count_from(cells[3], where)};
    if (count.correct[0] > count.instances || count.correct[1] > count.instances)
      throw InputError::at(where, "no more correct than instances", "more");
    if (!counts.emplace(cells[0], count).second) throw InputError::at(where, "each set once", cells[0]);
  }
  if (counts.empty()) throw InputError::at(file.string(), "at least one set", "none");
  return counts;
}

std::string format_floor(const SetCounts& counts) {
  std::string text = std::string(kHeader) + "\n";
  for (const auto& [set, count] : counts)
    text += set + "," + std::to_string(count.instances) + "," + std::to_string(count.correct[0]) + "," +
            std::to_string(count.correct[1]) + "\n";
  return text;
}

Verdict judge(const SetCount& floor, const SetCount& now) {
  constexpr std::array<const char*, 2> kLimits = {"0.05 d", "0.10 d"};
  if (now.instances != floor.instances)
    return {false, "OTHER SET: " + std::to_string(floor.instances) + " instances before"};
  Verdict verdict;
  const auto say = [&](const std::string& part) {
    verdict.text += (verdict.text.empty() ? "" : ", ") + part;
  };
  for (size_t k = 0; k < kLimits.size(); ++k) {
    const size_t before = floor.correct[k], here = now.correct[k];
    if (here + kMayLose < before) {
      verdict.passed = false;
      say("LOST " + std::to_string(before - here) + " at " + kLimits[k]);
    } else if (here < before) {
      say("one less at " + std::string(kLimits[k]) + ", allowed");
    } else if (here > before) {
      say(std::to_string(here - before) + " more at " + kLimits[k]);
    }
  }
  if (verdict.text.empty()) verdict.text = "kept";
  return verdict;
}

}  // namespace edgepose::bench
