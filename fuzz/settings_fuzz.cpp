#include "settings/matcher_settings.h"

#include "fuzz/input_check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  reads([&] {
    const Settings settings = parse_settings(text_of(data, size), "edgepose.toml");
    must_hold(settings.train.check().empty() && settings.scene.check().empty() &&
              settings.match.check().empty());
  });
  return 0;
}
