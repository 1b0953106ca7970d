#pragma once
#include <filesystem>
#include <iosfwd>

#include "client/service/recorder.h"
#include "messaging/udpm_receiver.h"

namespace edgepose {

/// What is in the log: messages by channel.
void print_recorded(std::ostream& out, const std::filesystem::path& file, const RecordCounters& counters);

/// What is not, by cause; a line that says so if nothing is missing.
void print_losses(std::ostream& out, const RecordCounters& recorded, const ReceiveCounters& received);

}  // namespace edgepose
