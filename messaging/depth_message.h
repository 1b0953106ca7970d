#pragma once
#include <cstdint>
#include <string>

#include "edgepose_lcm/depth_frame_t.hpp"
#include "matcher/types.h"

namespace edgepose {

/// A depth frame as the service works with it: SI, checked.
struct DepthFrame {
  int64_t capture_utime = 0;  ///< [us] since 1970, UTC
  int64_t sequence = 0;
  std::string camera;
  Camera intrinsics;
  DepthImage image;
};

enum class DepthEncoding : int8_t { kRaw16 = 0, kRvl = 1 };

/// Why a frame is not looked at; each is counted under its name().
enum class FrameFault {
  kNone,
  kName,        ///< camera's name empty or not printable
  kEncoding,    ///< unknown
  kSize,        ///< width, height out of range, or data of another size
  kScale,       ///< depth scale out of range
  kIntrinsics,  ///< focal length zero, negative or not of a camera
  kChecksum,    ///< data altered on the way
  kData,        ///< compressed data that no encoder makes
  kEmpty,       ///< no measurement at all
};
std::string name(FrameFault fault);

/// Checks what the fields mean and unpacks the depth. `frame` is as it was unless the answer is kNone;
/// `detail`: one line, "FIELD: expected E, found F". The times are the receiver's to judge.
FrameFault unpack(const edgepose_lcm::depth_frame_t& message, DepthFrame& frame, std::string& detail);

/// Depths are rounded to `depth_scale` metres; what does not fit into 16 bits becomes 0, not measured.
edgepose_lcm::depth_frame_t pack(const DepthFrame& frame, double depth_scale, DepthEncoding encoding);

}  // namespace edgepose
