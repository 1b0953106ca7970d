#pragma once
#include <stdexcept>
#include <string>

#include "common/error.h"

namespace edgepose {

/// The matcher and the renderer know nothing of files: says which one a complaint of theirs is about.
template <typename Work>
decltype(auto) naming(const std::string& file, Work&& work) {
  try {
    return work();
  } catch (const std::invalid_argument& error) {
    throw InputError(file + ": " + error.what());
  }
}

}  // namespace edgepose
