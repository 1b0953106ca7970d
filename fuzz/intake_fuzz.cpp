#include <algorithm>

#include "daemon/log.h"
#include "fuzz/input_check.h"
#include "messaging/big_endian.h"
#include "server/frame_intake.h"

// A message on the depth channel: whatever it holds, it is counted once, and what arrives is sound.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  set_log_level("off");
  FrameMailbox mailbox;
  Counters counters;
  FrameOptions options;
  options.max_age = options.max_ahead = 1e9;  // [s] times are another fuzzer's matter
  FrameIntake intake(mailbox, counters, [&] { return options; });
  ReceivedMessage message{kDepthChannel, std::make_unique<std::byte[]>(size), size};
  std::copy_n(reinterpret_cast<const std::byte*>(data), size, message.bytes.get());
  if (size >= 8)
    write_big_endian<int64_t>(edgepose_lcm::depth_frame_t::getHash(), {message.bytes.get(), size}, 0);
  intake.take(message);
  uint64_t refused = 0;
  for (const auto& [name, count] : counters.all()) refused += name.starts_with("frames_refused_") ? count : 0;
  must_hold(counters.get("frames_received") == 1 && refused <= 1);
  if (refused == 1) return 0;
  const auto frame = mailbox.take();
  must_hold(frame && frame->depth.image.depth.size() ==
                         static_cast<size_t>(frame->depth.image.width) * frame->depth.image.height);
  return 0;
}
