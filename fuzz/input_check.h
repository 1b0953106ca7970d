#pragma once
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "common/error.h"

namespace edgepose {

/// Stops the fuzzer (a finding) if `fact` does not hold.
inline void must_hold(bool fact) {
  if (!fact) std::abort();
}

/// Runs `read`: only InputError may come out, in one line of printable text. True if it read something.
template <typename Read>
bool reads(Read read) {
  try {
    read();
    return true;
  } catch (const InputError& error) {
    for (const unsigned char c : std::string_view(error.what())) must_hold(c >= ' ');
    return false;
  }
}

inline std::string_view text_of(const uint8_t* data, size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace edgepose
