#include <algorithm>

#include "fuzz/input_check.h"
#include "messaging/udpm_assembly.h"

// The input is a row of datagrams: each two bytes of length, one of sender and time, then its bytes.
extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace edgepose;
  AssemblyOptions options;
  options.max_message_bytes = 1 << 20;
  options.max_bytes = 3 << 20;
  options.max_unfinished = 8;
  UdpmAssembly assembly(options);
  int64_t now_us = 0;
  auto rest = std::as_bytes(std::span(data, size));
  while (rest.size() >= 3) {
    const size_t length =
        std::min<size_t>(data[size - rest.size()] + 256 * data[size - rest.size() + 1], rest.size() - 3);
    const uint8_t tag = data[size - rest.size() + 2];
    now_us += (tag >> 4) * 100'000;
    UdpmPacket packet;
    if (parse_udpm(rest.subspan(3, length), packet) == UdpmFault::kNone) {
      const auto message = assembly.add(tag & 7, packet, now_us);
      if (message) {
        must_hold(!message->channel.empty() && message->channel.size() <= kMaxChannelLength);
        // Every byte has been written: the sanitizers see a read of what was not.
        unsigned sum = 0;
        for (const std::byte b : message->data()) sum += std::to_integer<unsigned>(b);
        must_hold(sum <= 255 * message->size);
      }
    }
    must_hold(assembly.bytes() <= options.max_bytes && assembly.unfinished() <= options.max_unfinished);
    rest = rest.subspan(3 + length);
  }
  return 0;
}
