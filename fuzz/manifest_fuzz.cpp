#include <set>

#include "fuzz/input_check.h"
#include "server/manifest.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  reads([&] {
    std::set<std::string> names;
    for (const ManifestEntry& entry : parse_manifest(text_of(data, size), "registry.json")) {
      must_hold(name_fault(entry.name).empty() && names.insert(entry.name).second);
      must_hold(entry.file.find('/') == std::string::npos && entry.plan_file.find('/') == std::string::npos);
    }
  });
  return 0;
}
