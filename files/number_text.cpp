#include "files/number_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "files/text_cursor.h"

namespace edgepose {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

}  // namespace

std::string number_text(double value, int digits) {
  char buffer[64];
  const auto result =
      std::to_chars(buffer, buffer + sizeof(buffer), value, std::chars_format::general, digits);
  return std::string(buffer, result.ptr);
}

std::string numbers_text(const std::vector<double>& values, int digits) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ' ';
    text += number_text(value, digits);
  }
  return text;
}

std::optional<double> finite_number(std::string_view text) {
  const auto value = parse_number(trim(text));
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<int> identifier(std::string_view text) {
  const auto value = parse_integer(text);
  if (!value || *value < 0 || *value > std::numeric_limits<int>::max()) return std::nullopt;
  return static_cast<int>(*value);
}

std::string_view trim(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  size_t begin = 0;
  for (size_t end; (end = text.find(separator, begin)) != std::string_view::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

std::vector<std::string_view> split_at_blanks(std::string_view text) {
  std::vector<std::string_view> parts;
  for (std::string_view token; !(token = next_token(text)).empty();) parts.push_back(token);
  return parts;
}

std::string printable(std::string_view text) {
  std::string result(text.substr(0, 160));
  for (char& c : result)
    if (c < ' ' || c > '~') c = '?';
  return result;
}

}  // namespace edgepose
