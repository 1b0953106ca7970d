#include "demo/csv_table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "common/error.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

constexpr size_t kMaxCsvBytes = size_t{1} << 30;

/// Appends the fields of a line; returns how many.
size_t split(std::string_view line, std::vector<std::string_view>& fields) {
  size_t count = 1;
  for (size_t comma; (comma = line.find(',')) != std::string_view::npos; ++count) {
    fields.push_back(line.substr(0, comma));
    line.remove_prefix(comma + 1);
  }
  fields.push_back(line);
  return count;
}

}  // namespace

CsvTable::CsvTable(const std::filesystem::path& path)
    : path_(path), content_(read_whole_file(path, "a table (CSV)", kMaxCsvBytes)) {
  std::string_view rest = content_;
  for (size_t number = 1, end; (end = rest.find('\n')) != std::string_view::npos; ++number) {
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end + 1);
    const size_t fields = split(line, number == 1 ? names_ : cells_);
    if (number > 1 && fields != names_.size())
      throw InputError::at(path_.string() + ", line " + std::to_string(number),
                           std::to_string(names_.size()) + " fields", std::to_string(fields));
  }
}

size_t CsvTable::column(const std::string& name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  if (found == names_.end()) throw InputError::at(path_.string(), "a column " + name, "none");
  return static_cast<size_t>(found - names_.begin());
}

double CsvTable::number(size_t row, size_t column) const {
  const std::string_view field = text(row, column);
  double value = NAN;
  const auto [end, fault] = std::from_chars(field.data(), field.data() + field.size(), value);
  return fault == std::errc() && end == field.data() + field.size() ? value : NAN;
}

}  // namespace edgepose
