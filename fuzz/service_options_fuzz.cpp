#include "fuzz/input_check.h"
#include "server/service_options.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  reads([&] { parse_service_options(text_of(data, size), "edgeposed.toml").check("edgeposed.toml"); });
  return 0;
}
