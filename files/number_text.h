#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace edgepose {

/// The shortest text with at most `digits` significant digits. Independent of the locale.
std::string number_text(double value, int digits = 9);

/// The values with blanks between them.
std::string numbers_text(const std::vector<double>& values, int digits = 9);

/// The whole of `text`, blanks around it aside, as a number; "nan" and "inf" are none.
std::optional<double> finite_number(std::string_view text);
/// The whole of `text` as an identifier: an integer from 0 to 2^31 - 1, without blanks.
std::optional<int> identifier(std::string_view text);

/// Splits at each `separator`; n separators give n + 1 parts.
std::vector<std::string_view> split(std::string_view text, char separator);
/// Splits at blanks, tabs and line ends; no empty parts.
std::vector<std::string_view> split_at_blanks(std::string_view text);
std::string_view trim(std::string_view text);

/// What a library says about a file, for a one-line message: its first 160 bytes, unprintable ones as '?'.
std::string printable(std::string_view text);

}  // namespace edgepose
