#pragma once
#include <string>
#include <vector>

#include "server/registry.h"
#include "server/service_options.h"

namespace edgepose {

/// What is to be registered; the paths are foreign.
struct TrainingRequest {
  std::string name;
  std::string mesh;   ///< mesh file, or ...
  std::string model;  ///< ... a file of a trained model; exactly one of them
  std::string unit = "mm";
  std::string plan;  ///< drill plan, or empty
  bool any_size = false, activate = true;
};

struct TrainingResult {
  PreparedModel prepared;
  double seconds = 0;
  std::vector<std::string> notes;  ///< what was mended in the mesh
};

}  // namespace edgepose
