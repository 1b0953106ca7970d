#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace edgepose {

/// A CSV file of one heading and lines of as many fields, without quotes: what the controller and the
/// simulator write. A last line that is cut short is left out.
class CsvTable {
 public:
  /// Throws InputError if it cannot be read, is larger than 1 GB, or a line has another number of fields.
  explicit CsvTable(const std::filesystem::path& path);
  CsvTable(const CsvTable&) = delete;
  CsvTable& operator=(const CsvTable&) = delete;

  size_t rows() const { return names_.empty() ? 0 : cells_.size() / names_.size(); }
  /// Throws InputError if there is no such column.
  size_t column(const std::string& name) const;
  std::string_view text(size_t row, size_t column) const { return cells_[row * names_.size() + column]; }
  double number(size_t row, size_t column) const;  ///< NaN if it is none

 private:
  const std::filesystem::path path_;
  const std::string content_;
  std::vector<std::string_view> names_, cells_;  ///< into content_, row by row
};

}  // namespace edgepose
