#pragma once
#include <string>
#include <vector>

namespace edgepose {

/// A table for people, on the terminal and in Markdown alike. The first column is aligned left, others right.
class Table {
 public:
  explicit Table(std::vector<std::string> header) : header_(std::move(header)) {}
  void add(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }
  bool empty() const { return rows_.empty(); }
  std::string markdown() const;  ///< columns padded to equal width, ends with a newline

 private:
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
};

std::string fixed(double value, int decimals);  ///< "12.50"
std::string percent(double share);              ///< 0.9417 -> "94.17"
std::string count_text(size_t value);           ///< plain decimal
std::string milliseconds(double seconds);       ///< 0.0314 -> "31.4"

}  // namespace edgepose
