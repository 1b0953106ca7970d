#pragma once
#include "messaging/udpm_address.h"

namespace edgepose {

/// A non-blocking UDP socket that is a member of the group on every interface that multicast is routed to,
/// shares the port with other LCM programs, and reports the kernel's losses with each datagram. Throws
/// InputError with the system's reason. The caller closes it.
int open_udpm_socket(const UdpmAddress& address);

/// [bytes] of the receive buffer in effect, as the user counts them (the kernel doubles them for its own
/// use).
int receive_buffer_of(int socket);

}  // namespace edgepose
