#include "files/text_cursor.h"

#include <algorithm>
#include <charconv>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr bool is_line_end(char c) { return c == '\n' || c == '\r'; }
constexpr bool is_space(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f' || is_line_end(c); }

template <typename T>
std::optional<T> parse_whole(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

std::string_view TextCursor::token() {
  while (position_ < text_.size() && is_space(text_[position_])) ++position_;
  last_ = position_;
  while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
  return text_.substr(last_, position_ - last_);
}

std::string_view TextCursor::token_on_line() {
  while (position_ < text_.size() && is_space(text_[position_]) && !is_line_end(text_[position_]))
    ++position_;
  last_ = position_;
  while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
  return text_.substr(last_, position_ - last_);
}

std::string_view TextCursor::line() {
  last_ = position_;
  while (position_ < text_.size() && !is_line_end(text_[position_])) ++position_;
  const std::string_view result = text_.substr(last_, position_ - last_);
  if (position_ < text_.size()) {
    const bool two = text_[position_] == '\r' && position_ + 1 < text_.size() && text_[position_ + 1] == '\n';
    position_ += two ? 2 : 1;
  }
  return result;
}

double TextCursor::number(const char* what) {
  const std::string_view text = token();
  const std::optional<double> value = parse_number(text);
  if (!value) fail_at_token(std::string("a number (") + what + ")", text);
  return *value;
}

void TextCursor::fail(const std::string& expected, const std::string& found) const {
  size_t number = 1;
  for (size_t i = 0; i < last_; ++i) {
    number += text_[i] == '\n' || (text_[i] == '\r' && (i + 1 == text_.size() || text_[i + 1] != '\n'));
  }
  throw InputError::at(name_ + ", line " + std::to_string(number), expected, found);
}

void TextCursor::fail_at_token(const std::string& expected, std::string_view token) const {
  fail(expected, token.empty() ? (at_end() ? "the end of the file" : "the end of the line") : quoted(token));
}

std::optional<double> parse_number(std::string_view text) { return parse_whole<double>(text); }
std::optional<int64_t> parse_integer(std::string_view text) { return parse_whole<int64_t>(text); }
std::optional<uint64_t> parse_count(std::string_view text) { return parse_whole<uint64_t>(text); }

std::string_view next_token(std::string_view& text) {
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end = std::find_if(begin, text.end(), is_space);
  const std::string_view token = text.substr(begin - text.begin(), end - begin);
  text.remove_prefix(end - text.begin());
  return token;
}

std::string quoted(std::string_view text) {
  constexpr size_t kLongest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, kLongest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > kLongest ? "...'" : "'");
}

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return result;
}

}  // namespace edgepose
