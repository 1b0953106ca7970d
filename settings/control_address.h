#pragma once
#include <filesystem>

namespace edgepose {

/// Where the daemon takes commands and its clients look for it, unless they are told otherwise:
/// $EDGEPOSE_SOCKET, else control.sock in systemd's $RUNTIME_DIRECTORY, else in /run/edgepose if that can be
/// used, else in $XDG_RUNTIME_DIR/edgepose, else in /tmp/edgepose-UID. Throws InputError if that is somebody
/// else's.
std::filesystem::path default_control_socket();

}  // namespace edgepose
