#pragma once
#include <cstdlib>
#include <string>

#include "common/private_folder.h"

namespace edgepose {

/// A folder of its own, removed at the end. In $TMPDIR or /tmp; a socket's path must be short, so a long
/// $TMPDIR does not count.
class TemporaryFolder : public PrivateFolder {
 public:
  TemporaryFolder() : PrivateFolder("edgepose_", parent()) {}

 private:
  static std::string parent() {
    const char* given = std::getenv("TMPDIR");
    const bool is_short = given != nullptr && *given != 0 && std::string(given).size() <= 40;
    return is_short ? given : "/tmp";
  }
};

}  // namespace edgepose
