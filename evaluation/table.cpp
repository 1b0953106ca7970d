#include "evaluation/table.h"

#include <algorithm>
#include <cstdio>

namespace edgepose {
namespace {

std::string padded(const std::string& text, size_t width, bool left) {
  const std::string blanks(width - std::min(width, text.size()), ' ');
  return left ? text + blanks : blanks + text;
}

}  // namespace

std::string Table::markdown() const {
  std::vector<size_t> widths;
  for (const std::string& cell : header_) widths.push_back(std::max<size_t>(3, cell.size()));
  for (const auto& row : rows_)
    for (size_t i = 0; i < std::min(row.size(), widths.size()); ++i)
      widths[i] = std::max(widths[i], row[i].size());
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string text = "|";
    for (size_t i = 0; i < widths.size(); ++i)
      text.append(" ").append(padded(i < cells.size() ? cells[i] : "", widths[i], i == 0)).append(" |");
    return text + "\n";
  };
  std::string text = line(header_) + "|";
  for (size_t i = 0; i < widths.size(); ++i)
    text.append(i == 0 ? ":" : "-").append(widths[i], '-').append(i == 0 ? "-|" : ":|");
  text += "\n";
  for (const auto& row : rows_) text += line(row);
  return text;
}

std::string fixed(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}
std::string percent(double share) { return fixed(100 * share, 2); }
std::string count_text(size_t value) { return std::to_string(value); }
std::string milliseconds(double seconds) { return fixed(1000 * seconds, 1); }

}  // namespace edgepose
