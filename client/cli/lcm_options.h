#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "messaging/udpm_address.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {

/// Adds --url, checked; the default is kDefaultLcmUrl.
void add_url_option(CLI::App& command, std::string& url);

/// Longest time taken by any option in seconds: about a year.
inline constexpr double kMaxSeconds = 3e7;

/// On stderr, if the kernel has granted less than was asked for: depth frames will be lost.
void warn_of_small_buffer(const UdpmReceiver& receiver, const UdpmAddress& address);

/// What a receiver has lost, in words and by cause: "12 datagrams by the kernel, 3 malformed"; empty if
/// nothing.
std::string losses(const ReceiveCounters& counters);

}  // namespace edgepose
