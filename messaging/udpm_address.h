#pragma once
#include <cstdint>
#include <string>

namespace edgepose {

/// Where LCM's UDP multicast goes, as liblcm's provider URL says:
/// "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304".
struct UdpmAddress {
  uint32_t group = 0;                  ///< IPv4, host byte order; multicast
  uint16_t port = 0;                   ///< UDP
  uint8_t ttl = 0;                     ///< hops; 0 = stays on this machine
  int receive_buffer_bytes = 4 << 20;  ///< [bytes] asked of the kernel; its default loses depth frames
};

/// What is listened to and published on unless the configuration names another: LCM's own default, on this
/// machine only.
inline constexpr const char* kDefaultLcmUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";

/// Throws InputError that names the part that is wrong: another provider, an address that is no IPv4
/// multicast group, a port, ttl or buffer out of range, an unknown option.
UdpmAddress parse_udpm_url(const std::string& url);

/// The URL that parse_udpm_url() reads as this address.
std::string to_url(const UdpmAddress& address);

}  // namespace edgepose
