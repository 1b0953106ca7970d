#pragma once
#include <algorithm>
#include <stdexcept>
#include <string>

namespace edgepose {

/// `text` with a space for each control character, so that it is one line and does nothing to a terminal.
inline std::string one_line(std::string text) {
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

/// Bad input from outside: a file, an option, a message. `what()` is one line for the person at the
/// terminal: where, what was expected, what was found, what to do. Programs print it and exit with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(one_line(message)) {}

  /// "FILE: expected E, found F" and, if given, "; do D".
  static InputError at(const std::string& where, const std::string& expected, const std::string& found,
                       const std::string& advice = "") {
    return InputError(where + ": expected " + expected + ", found " + found +
                      (advice.empty() ? "" : "; " + advice));
  }
};

}  // namespace edgepose
