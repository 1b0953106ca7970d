#pragma once
#include "client/service/control_client.h"

namespace edgepose {

/// A connected, non-blocking socket; the caller closes it. Throws InputError that says how to start the
/// daemon if nobody listens there.
int open_control_socket(const ControlAddress& address);

}  // namespace edgepose
