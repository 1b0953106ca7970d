#pragma once
#include <cstdlib>
#include <filesystem>
#include <string>

/// The test sets that lie beside the project, if they are there: $EDGEPOSE_SHARED or ../shared.
inline std::filesystem::path shared_data(const std::string& what) {
  const char* from_environment = std::getenv("EDGEPOSE_SHARED");
  const std::filesystem::path root =
      from_environment ? from_environment : std::filesystem::path(EDGEPOSE_SOURCE_DIR) / ".." / "shared";
  return root / "data" / what;
}

/// Skips the running test, loudly, if the test set is missing.
#define EDGEPOSE_NEEDS_SHARED(what)                                                                      \
  if (!std::filesystem::exists(shared_data(what)))                                                       \
  GTEST_SKIP() << "SKIPPED, test data missing: " << shared_data(what) << " (set EDGEPOSE_SHARED to the " \
               << "folder that holds data/" << (what) << ")"
