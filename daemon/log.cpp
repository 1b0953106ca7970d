#include "daemon/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <mutex>

namespace edgepose {
namespace {

constexpr std::chrono::seconds kPause{10};
constexpr size_t kMaxValue = 500;   // what comes from outside may be long
constexpr size_t kMaxCauses = 256;  // causes are the program's own words; a limit all the same

spdlog::logger& logger() {
  static const auto instance = [] {
    auto made = spdlog::stderr_logger_mt("edgepose");
    made->set_pattern("time=%Y-%m-%dT%H:%M:%S.%fZ level=%l %v", spdlog::pattern_time_type::utc);
    made->flush_on(spdlog::level::trace);
    return made;
  }();
  return *instance;
}

spdlog::level::level_enum level_of(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

std::string quoted(const std::string& value) {
  const auto is_plain = [](unsigned char c) {
    return c > ' ' && c < 0x7f && c != '"' && c != '=' && c != '\\';
  };
  if (!value.empty() && value.size() <= kMaxValue && std::all_of(value.begin(), value.end(), is_plain))
    return value;
  std::string text = "\"";
  for (const unsigned char c : value.substr(0, kMaxValue)) {
    if (c == '"' || c == '\\') text += '\\';
    text += c < ' ' || c == 0x7f ? ' ' : static_cast<char>(c);
  }
  return text + '"';
}

struct Repeated {
  std::chrono::steady_clock::time_point last;
  uint64_t since = 0;
};

}  // namespace

void log_event(LogLevel level, const std::string& event, const LogFields& fields) {
  if (!logger().should_log(level_of(level))) return;
  std::string line = "event=" + event;
  for (const auto& [key, value] : fields) line += ' ' + key + '=' + quoted(value);
  logger().log(level_of(level), line);
}

void log_limited(LogLevel level, const std::string& event, const std::string& cause,
                 const LogFields& fields) {
  static std::mutex mutex;
  static std::map<std::string, Repeated> causes;
  uint64_t repeated = 0;
  {
    const std::scoped_lock lock(mutex);
    const auto now = std::chrono::steady_clock::now();
    const auto [entry, is_new] = causes.try_emplace(event + ' ' + cause, Repeated{now, 0});
    if (!is_new && now - entry->second.last < kPause) {
      ++entry->second.since;
      return;
    }
    repeated = entry->second.since;
    entry->second = {now, 0};
    if (causes.size() > kMaxCauses) causes.clear();
  }
  LogFields all = {{"cause", cause}};
  all.insert(all.end(), fields.begin(), fields.end());
  if (repeated > 0) all.emplace_back("repeated", std::to_string(repeated));
  log_event(level, event, all);
}

void set_log_level(const std::string& level) { logger().set_level(spdlog::level::from_str(level)); }

}  // namespace edgepose
