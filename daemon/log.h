#pragma once
#include <string>
#include <utility>
#include <vector>

namespace edgepose {

enum class LogLevel { kDebug, kInfo, kWarning, kError };

/// "key=value" pairs of a log line.
using LogFields = std::vector<std::pair<std::string, std::string>>;

/// One line on stderr: time=... level=... event=EVENT key=value ... Values with blanks, quotes or control
/// characters are quoted and escaped. Safe from any thread.
void log_event(LogLevel level, const std::string& event, const LogFields& fields = {});

/// The same, but of equal `event` and `cause` only the first and then one every ten seconds, with how many
/// there have been since (repeated=N): what comes from outside must not fill the disk.
void log_limited(LogLevel level, const std::string& event, const std::string& cause, const LogFields& fields);

/// "debug", "info", "warning" or "error": lines below it are left out.
void set_log_level(const std::string& level);

}  // namespace edgepose
