#pragma once
#include <stdexcept>
#include <string>

namespace edgepose {

/// Bad input from outside: a file, an option, a message. `what()` is one line for the person at the
/// terminal: where, what was expected, what was found, what to do. Programs print it and exit with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;

  /// "FILE: expected E, found F" and, if given, "; do D".
  static InputError at(const std::string& where, const std::string& expected, const std::string& found,
                       const std::string& advice = "") {
    return InputError(where + ": expected " + expected + ", found " + found +
                      (advice.empty() ? "" : "; " + advice));
  }
};

}  // namespace edgepose
