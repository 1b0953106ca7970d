#include "client/cli/render_scene.h"
#include "fuzz/input_check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  for (const std::optional<int> image : {std::optional<int>(), std::optional<int>(0)})
    reads([&] {
      const auto objects = parse_scene_file(text_of(data, size), "scene.json", image);
      must_hold(!objects.empty());
      for (const PlacedMesh& object : objects) must_hold(object.camera_T_model.matrix().allFinite());
      // What was read can be written, and comes back.
      must_hold(parse_scene_file(scene_file_text(objects, ""), "again.json", 0).size() == objects.size());
    });
  return 0;
}
