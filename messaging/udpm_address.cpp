#include "messaging/udpm_address.h"

#include <arpa/inet.h>

#include <array>
#include <charconv>
#include <string_view>

#include "common/error.h"

namespace edgepose {
namespace {

constexpr std::string_view kScheme = "udpm://";
constexpr int kMaxBuffer = 1 << 30;

/// The number from `low` to `high` that `text` is, all of it.
int number(const std::string& url, const std::string& what, std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < low || value > high)
    throw InputError::at(url, what + " from " + std::to_string(low) + " to " + std::to_string(high),
                         "'" + std::string(text) + "'");
  return value;
}

void read_option(const std::string& url, std::string_view option, UdpmAddress& address) {
  const size_t equals = std::min(option.find('='), option.size());
  const std::string_view key = option.substr(0, equals);
  const std::string_view value = option.substr(std::min(equals + 1, option.size()));
  if (key == "ttl") {
    address.ttl = static_cast<uint8_t>(number(url, "ttl", value, 0, 255));
  } else if (key == "recv_buf_size") {
    address.receive_buffer_bytes = number(url, "recv_buf_size", value, 1 << 12, kMaxBuffer);
  } else {
    throw InputError::at(url, "ttl or recv_buf_size", "'" + std::string(key) + "'");
  }
}

}  // namespace

UdpmAddress parse_udpm_url(const std::string& url) {
  if (!url.starts_with(kScheme))
    throw InputError::at(url, "an LCM address udpm://GROUP:PORT?ttl=N", "another provider",
                         std::string("the default is ") + kDefaultLcmUrl);
  const std::string_view rest = std::string_view(url).substr(kScheme.size());
  const size_t question = std::min(rest.find('?'), rest.size());
  const std::string_view host = rest.substr(0, question);
  const size_t colon = host.find(':');
  const std::string group(host.substr(0, std::min(colon, host.size())));
  in_addr ip{};
  if (inet_pton(AF_INET, group.c_str(), &ip) != 1 || !IN_MULTICAST(ntohl(ip.s_addr)))
    throw InputError::at(url, "an IPv4 multicast group, 224.0.0.0 to 239.255.255.255", "'" + group + "'");
  if (colon == std::string_view::npos) throw InputError::at(url, "GROUP:PORT", "no port");

  UdpmAddress address;
  address.group = ntohl(ip.s_addr);
  address.port = static_cast<uint16_t>(number(url, "a port", host.substr(colon + 1), 1, 65535));
  std::string_view options = rest.substr(std::min(question + 1, rest.size()));
  while (!options.empty()) {
    const size_t end = std::min(options.find('&'), options.size());
    read_option(url, options.substr(0, end), address);
    options = options.substr(std::min(end + 1, options.size()));
  }
  return address;
}

std::string to_url(const UdpmAddress& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  const in_addr ip{htonl(address.group)};
  inet_ntop(AF_INET, &ip, text.data(), text.size());
  return std::string(kScheme) + text.data() + ":" + std::to_string(address.port) +
         "?ttl=" + std::to_string(address.ttl) +
         "&recv_buf_size=" + std::to_string(address.receive_buffer_bytes);
}

}  // namespace edgepose
