#include "fuzz/mesh_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  edgepose::fuzz_mesh(data, size, "fuzz.ply");
  return 0;
}
