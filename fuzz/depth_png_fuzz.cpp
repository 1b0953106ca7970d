#include <zlib.h>

#include <cmath>
#include <span>
#include <vector>

#include "files/depth_file.h"
#include "fuzz/input_check.h"

namespace {

using namespace edgepose;

void parse(std::span<const uint8_t> png) {
  reads([&] {
    const DepthImage image = parse_depth_png(std::as_bytes(png), "fuzz.png", 0.001);
    must_hold(image.width > 0 && image.height > 0);
    must_hold(image.depth.size() == static_cast<size_t>(image.width) * image.height);
    bool measured = false;
    for (const float depth : image.depth) {
      must_hold(std::isfinite(depth) && depth >= 0);
      measured |= depth > 0;
    }
    must_hold(measured);
  });
}

/// Mutations seldom keep the checksums of the chunks: put them right, so that the decoder sees more.
void mend_checksums(std::vector<uint8_t>& png) {
  for (size_t at = 8; at + 12 <= png.size();) {
    const size_t length =
        size_t{png[at]} << 24 | size_t{png[at + 1]} << 16 | size_t{png[at + 2]} << 8 | png[at + 3];
    if (length > png.size() - at - 12) return;
    const auto sum = static_cast<uint32_t>(crc32(0, &png[at + 4], static_cast<uInt>(length + 4)));
    for (size_t i = 0; i < 4; ++i) png[at + 8 + length + i] = static_cast<uint8_t>(sum >> (24 - 8 * i));
    at += 12 + length;
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  parse({data, size});
  std::vector<uint8_t> mended(data, data + size);
  mend_checksums(mended);
  parse(mended);
  return 0;
}
