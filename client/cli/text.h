#pragma once
#include <string>

namespace edgepose {

/// printf into a string.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace edgepose
