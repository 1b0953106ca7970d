#include "bus/open_bus.h"

#include "bus/pcap_replay_bus.h"
#include "bus/socket_can_bus.h"
#include "bus/unix_bus.h"
#include "common/error.h"

namespace edgepose {

std::unique_ptr<CanBus> open_bus(const std::string& name, const std::vector<uint16_t>& ids,
                                 const std::vector<uint16_t>& confirm) {
  const size_t colon = name.find(':');
  if (colon == std::string::npos)
    return std::make_unique<SocketCanBus>(
        name, SocketCanOptions{.ids = ids, .receive_buffer_bytes = 256 << 10, .confirm = confirm});
  const std::string kind = name.substr(0, colon), rest = name.substr(colon + 1);
  if (kind == "unix") return std::make_unique<UnixBus>(rest);
  if (kind == "pcap") return std::make_unique<PcapReplayBus>(rest);
  throw InputError::at("bus", "can0, unix:/path or pcap:/file", name);
}

}  // namespace edgepose
