#include "client/cli/lcm_options.h"

#include <iostream>
#include <vector>

#include "common/error.h"

namespace edgepose {

void add_url_option(CLI::App& command, std::string& url) {
  url = kDefaultLcmUrl;
  command.add_option("--url", url, std::string("LCM's address (default ") + kDefaultLcmUrl + ")")
      ->check(
          [](const std::string& text) -> std::string {
            try {
              parse_udpm_url(text);
            } catch (const InputError& error) {
              return error.what();
            }
            return "";
          },
          "");
}

void warn_of_small_buffer(const UdpmReceiver& receiver, const UdpmAddress& address) {
  if (receiver.receive_buffer_bytes() >= address.receive_buffer_bytes) return;
  std::cerr << "edgepose: warning: the kernel grants a receive buffer of " << receiver.receive_buffer_bytes()
            << " of " << address.receive_buffer_bytes
            << " bytes: depth frames will be lost; sysctl -w net.core.rmem_max="
            << address.receive_buffer_bytes << " mends it" << std::endl;
}

std::string losses(const ReceiveCounters& counters) {
  const std::vector<std::pair<uint64_t, const char*>> causes = {
      {counters.lost_by_kernel, "datagrams by the kernel (receive buffer full)"},
      {counters.malformed, "datagrams malformed"},
      {counters.assembly.given_up, "messages incomplete"},
      {counters.assembly.refused, "fragments refused"},
      {counters.assembly.duplicates, "fragments twice"}};
  std::string text;
  for (const auto& [count, cause] : causes)
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + cause;
  return text;
}

}  // namespace edgepose
