#include "messaging/depth_message.h"

#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "messaging/rvl.h"
#include "messaging/udpm_packet.h"

namespace edgepose {
namespace {

constexpr int kMaxSide = 4096;
constexpr double kLeastScale = 1e-7, kMostScale = 0.1;  // [m]
constexpr double kLeastFocal = 0.1, kMostFocal = 100;   // [longer side of the image]

std::span<const std::byte> bytes_of(const std::vector<uint8_t>& data) {
  return std::as_bytes(std::span(data));
}

int64_t checksum(const std::vector<uint8_t>& data) {
  return static_cast<int64_t>(crc32_z(0, data.data(), data.size()));
}

std::string expected(const std::string& field, const std::string& what, const std::string& found) {
  return field + ": expected " + what + ", found " + found;
}

bool is_printable(const std::string& text) {
  return !text.empty() && text.size() <= kMaxChannelLength &&
         std::all_of(text.begin(), text.end(), [](char c) { return c > ' ' && c <= '~'; });
}

bool is_sound(const edgepose_lcm::depth_frame_t& m) {
  const double side = std::max(m.width, m.height);
  const auto is_focal = [&](double f) { return f >= kLeastFocal * side && f <= kMostFocal * side; };
  const auto is_centre = [&](double c) { return std::abs(c) <= 10 * side; };
  return is_focal(m.fx) && is_focal(m.fy) && is_centre(m.cx) && is_centre(m.cy);
}

bool unpack_depth(const edgepose_lcm::depth_frame_t& m, std::vector<uint16_t>& depth) {
  if (m.encoding == edgepose_lcm::depth_frame_t::RVL) return decode_rvl(bytes_of(m.data), depth);
  for (size_t i = 0; i < depth.size(); ++i)
    depth[i] = static_cast<uint16_t>(m.data[2 * i] | m.data[2 * i + 1] << 8);
  return true;
}

}  // namespace

std::string name(FrameFault fault) {
  switch (fault) {
    case FrameFault::kNone:
      return "none";
    case FrameFault::kName:
      return "bad_camera_name";
    case FrameFault::kEncoding:
      return "unknown_encoding";
    case FrameFault::kSize:
      return "wrong_size";
    case FrameFault::kScale:
      return "bad_depth_scale";
    case FrameFault::kIntrinsics:
      return "bad_intrinsics";
    case FrameFault::kChecksum:
      return "wrong_checksum";
    case FrameFault::kData:
      return "bad_compressed_data";
    case FrameFault::kEmpty:
      return "no_measurement";
  }
  return "unknown";
}

FrameFault unpack(const edgepose_lcm::depth_frame_t& m, DepthFrame& frame, std::string& detail) {
  using edgepose_lcm::depth_frame_t;
  const auto refuse = [&](FrameFault fault, const std::string& what) {
    detail = what;
    return fault;
  };
  if (!is_printable(m.camera))
    return refuse(FrameFault::kName, expected("camera", "1 to 63 printable characters", "others"));
  if (m.encoding != depth_frame_t::RAW16 && m.encoding != depth_frame_t::RVL)
    return refuse(FrameFault::kEncoding,
                  expected("encoding", "RAW16 (0) or RVL (1)", std::to_string(m.encoding)));
  if (m.width < 1 || m.height < 1 || m.width > kMaxSide || m.height > kMaxSide)
    return refuse(FrameFault::kSize, expected("width, height", "1 to 4096 pixels",
                                              std::to_string(m.width) + " x " + std::to_string(m.height)));
  const size_t pixels = static_cast<size_t>(m.width) * static_cast<size_t>(m.height);
  if (m.encoding == depth_frame_t::RAW16 && m.data.size() != 2 * pixels)
    return refuse(FrameFault::kSize,
                  expected("data",
                           std::to_string(2 * pixels) + " bytes for " + std::to_string(m.width) + " x " +
                               std::to_string(m.height) + " pixels",
                           std::to_string(m.data.size())));
  if (!(m.depth_scale >= kLeastScale && m.depth_scale <= kMostScale))
    return refuse(FrameFault::kScale,
                  expected("depth_scale", "metres per unit, 1e-7 to 0.1", std::to_string(m.depth_scale)));
  if (!is_sound(m))
    return refuse(FrameFault::kIntrinsics,
                  expected("fx, fy, cx, cy", "a camera's, in pixels",
                           std::to_string(m.fx) + ", " + std::to_string(m.fy) + ", " + std::to_string(m.cx) +
                               ", " + std::to_string(m.cy)));
  if (const int64_t found = checksum(m.data); found != m.checksum)
    return refuse(FrameFault::kChecksum,
                  expected("checksum", std::to_string(m.checksum), std::to_string(found)));
  std::vector<uint16_t> depth(pixels);
  if (!unpack_depth(m, depth))
    return refuse(FrameFault::kData,
                  expected("data", "RVL for " + std::to_string(pixels) + " pixels", "other"));
  if (std::all_of(depth.begin(), depth.end(), [](uint16_t d) { return d == 0; }))
    return refuse(FrameFault::kEmpty, expected("data", "a measurement", "zeros only"));

  frame.capture_utime = m.capture_utime;
  frame.sequence = m.sequence;
  frame.camera = m.camera;
  frame.intrinsics = {m.fx, m.fy, m.cx, m.cy};
  frame.image.width = m.width, frame.image.height = m.height;
  frame.image.depth.resize(pixels);
  // As a depth PNG is read: the same image gives the same bits whichever way it comes.
  std::transform(depth.begin(), depth.end(), frame.image.depth.begin(),
                 [&](uint16_t d) { return static_cast<float>(d * m.depth_scale); });
  return FrameFault::kNone;
}

edgepose_lcm::depth_frame_t pack(const DepthFrame& frame, double depth_scale, DepthEncoding encoding) {
  std::vector<uint16_t> depth;
  depth.reserve(frame.image.depth.size());
  for (const float z : frame.image.depth) {
    const double units = std::round(static_cast<double>(z) / depth_scale);
    depth.push_back(units >= 0 && units <= 0xffff ? static_cast<uint16_t>(units) : uint16_t{0});
  }
  edgepose_lcm::depth_frame_t m{};
  m.capture_utime = frame.capture_utime;
  m.sequence = frame.sequence;
  m.camera = frame.camera;
  m.width = frame.image.width, m.height = frame.image.height;
  m.fx = frame.intrinsics.fx, m.fy = frame.intrinsics.fy;
  m.cx = frame.intrinsics.cx, m.cy = frame.intrinsics.cy;
  m.depth_scale = depth_scale;
  m.encoding = static_cast<int8_t>(encoding);
  if (encoding == DepthEncoding::kRvl) {
    const auto bytes = encode_rvl(depth);
    const auto* begin = reinterpret_cast<const uint8_t*>(bytes.data());
    m.data.assign(begin, begin + bytes.size());
  } else {
    for (const uint16_t d : depth) {
      m.data.push_back(static_cast<uint8_t>(d & 0xff));
      m.data.push_back(static_cast<uint8_t>(d >> 8));
    }
  }
  m.size = static_cast<int32_t>(m.data.size());
  m.checksum = checksum(m.data);
  return m;
}

}  // namespace edgepose
