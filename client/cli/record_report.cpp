#include "client/cli/record_report.h"

#include <ostream>

#include "client/cli/lcm_options.h"
#include "client/cli/text.h"

namespace edgepose {

void print_recorded(std::ostream& out, const std::filesystem::path& file, const RecordCounters& counters) {
  out << "recorded " << counters.messages << " messages, "
      << formatted("%.1f MB", 1e-6 * static_cast<double>(counters.bytes)) << ", in " << file.string() << '\n';
  for (const auto& [channel, count] : counters.channels)
    out << formatted("  %-32s %10llu\n", channel.c_str(), static_cast<unsigned long long>(count));
}

void print_losses(std::ostream& out, const RecordCounters& recorded, const ReceiveCounters& received) {
  std::string text = losses(received);
  const auto add = [&](uint64_t count, const char* cause) {
    if (count > 0) text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + cause;
  };
  add(recorded.dropped, "messages that the disk was too slow for (--queue)");
  add(recorded.refused, "messages too long for a log");
  out << "lost: " << (text.empty() ? "nothing" : text) << std::endl;
}

}  // namespace edgepose
