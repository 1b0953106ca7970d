#include <cmath>

#include "files/bop_results.h"
#include "fuzz/input_check.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  std::vector<BopResult> results;
  if (!reads([&] { results = parse_bop_results(text_of(data, size), "results.csv"); })) return 0;
  bool far = false;  // at the very limit, rounding to nine digits may carry a pose beyond it
  for (const BopResult& result : results) {
    must_hold(result.scene_id >= 0 && result.image_id >= 0 && result.object_id >= 0);
    must_hold(std::isfinite(result.score) && std::isfinite(result.time));
    const Eigen::Matrix3d& rotation = result.camera_T_model.linear();
    must_hold((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm() < 1e-9);
    far |= result.camera_T_model.translation().norm() > 999;
  }
  // What was read can be written and read again.
  std::vector<BopResult> again;
  const bool read_again = reads([&] { again = parse_bop_results(format_bop_results(results), "again.csv"); });
  must_hold(far || (read_again && again.size() == results.size()));
  return 0;
}
