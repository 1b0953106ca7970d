#include <zlib.h>

#include <cmath>
#include <vector>

#include "fuzz/input_check.h"
#include "messaging/checked_decode.h"
#include "messaging/depth_message.h"

// A depth frame whose lengths are right, so that the checks behind them are reached: 6 bytes of header, then
// data.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  if (size < 6) return 0;
  edgepose_lcm::depth_frame_t message{};
  message.camera = "camera";
  message.encoding = static_cast<int8_t>(data[0] % 3);
  message.width = data[1] - 4, message.height = data[2] - 4;
  message.fx = message.fy = data[3] * 4.0;
  message.cx = data[4], message.cy = -static_cast<double>(data[4]);
  message.depth_scale = std::pow(10.0, data[5] % 10 - 8.0);
  message.data.assign(data + 6, data + size);
  message.size = static_cast<int32_t>(message.data.size());
  message.checksum = static_cast<int64_t>(crc32_z(0, message.data.data(), message.data.size()));
  DepthFrame frame;
  std::string detail;
  const FrameFault fault = unpack(message, frame, detail);
  must_hold((fault == FrameFault::kNone) == detail.empty());
  if (fault != FrameFault::kNone) return 0;
  must_hold(frame.image.depth.size() == static_cast<size_t>(message.width) * message.height);
  for (const float z : frame.image.depth) must_hold(z >= 0 && std::isfinite(z));
  // Packed again it is the same image.
  DepthFrame again;
  const auto encoding = static_cast<DepthEncoding>(message.encoding);
  must_hold(unpack(pack(frame, message.depth_scale, encoding), again, detail) == FrameFault::kNone);
  must_hold(again.image.depth == frame.image.depth);
  return 0;
}
