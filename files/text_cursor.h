#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace edgepose {

/// Reads bytes as text, token by token or line by line, never past the end. Knows the file's name and, when
/// something is wrong, the line. Independent of the locale.
class TextCursor {
 public:
  TextCursor(std::string_view text, std::string name) : text_(text), name_(std::move(name)) {}
  TextCursor(std::span<const std::byte> bytes, std::string name)
      : TextCursor(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()),
                   std::move(name)) {}

  /// Next run of characters without white space, across lines; empty at the end.
  std::string_view token();
  /// Next token if there is one on this line, else empty (and the cursor stays on the line).
  std::string_view token_on_line();
  /// Rest of this line without its end; the cursor moves to the next one. Lines end with \n, \r\n or \r.
  std::string_view line();

  /// Next token as a number (nan and inf are numbers). `what` names it in the error.
  double number(const char* what);

  /// Goes on at `position`, at most the size of the text.
  void skip_to(size_t position) { position_ = last_ = position < text_.size() ? position : text_.size(); }
  bool at_end() const { return position_ >= text_.size(); }
  size_t position() const { return position_; }
  size_t remaining() const { return text_.size() - position_; }
  const std::string& name() const { return name_; }

  /// Throws InputError "NAME, line N: expected E, found F"; the line is that of the last token or line read.
  [[noreturn]] void fail(const std::string& expected, const std::string& found) const;
  /// The same, for a token: quotes it, or says that the file ended.
  [[noreturn]] void fail_at_token(const std::string& expected, std::string_view token) const;

 private:
  std::string_view text_;
  std::string name_;
  size_t position_ = 0;
  size_t last_ = 0;  ///< where the last token or line began
};

/// The whole of `text` as a decimal number ("nan" and "inf" are numbers); nothing if it is none or out of
/// range.
std::optional<double> parse_number(std::string_view text);
std::optional<int64_t> parse_integer(std::string_view text);
/// The same, without a sign.
std::optional<uint64_t> parse_count(std::string_view text);

/// First token of `text`, which is shortened by it; empty at the end.
std::string_view next_token(std::string_view& text);

/// For messages: in quotes, at most 40 characters, only printable ones.
std::string quoted(std::string_view text);

/// Letters in ASCII lower case.
std::string lower_case(std::string_view text);

}  // namespace edgepose
