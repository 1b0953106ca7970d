#pragma once
#include <sys/types.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/temporary_folder.h"

namespace edgepose::test {

using Folder = TemporaryFolder;

/// A program that runs beside the test; killed by the destructor if need be.
class Process {
 public:
  /// Its standard error, and what it prints, go to `log`.
  Process(const std::vector<std::string>& command, const std::filesystem::path& log,
          const std::vector<std::string>& environment = {});
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process();

  void signal(int number) const;
  /// Exit code, or -signal; nothing if it still runs after so many seconds.
  std::optional<int> wait(double seconds);
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  std::optional<int> end_;
};

/// A real edgeposed with a state folder and a control socket of its own. The network is the test's.
class Daemon {
 public:
  /// `config`: content of its configuration file. Starts, and waits until it says READY (at most 20 s).
  explicit Daemon(const std::filesystem::path& folder, const std::string& config = "");

  bool ready() const { return ready_seconds_.has_value(); }
  double ready_seconds() const { return ready_seconds_.value_or(1e9); }  ///< from exec to READY=1
  Process& process() { return process_; }

  /// The whole answer to one request; an empty object if none came within 60 s.
  nlohmann::json call(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  /// `result` of the answer; throws std::runtime_error with the error.
  nlohmann::json result(const std::string& method, const nlohmann::json& params = nlohmann::json::object());
  /// What it counts under `name`.
  int64_t counter(const std::string& name);
  std::string log() const;
  std::filesystem::path socket() const { return folder_ / "control.sock"; }

 private:
  class Ready;
  std::filesystem::path folder_;
  std::string notify_;
  int notify_socket_;
  Process process_;
  std::optional<double> ready_seconds_;
};

/// One line to a Unix socket, one line back; empty if none came within `seconds`.
std::string ask(const std::filesystem::path& socket, const std::string& line, double seconds = 60);
/// Connected, or -1.
int connect_to(const std::filesystem::path& socket);

std::string read_text(const std::filesystem::path& path);
/// build/.../bin/NAME
std::string program(const std::string& name);

/// Until `condition` holds; false after so many seconds.
template <class Condition>
bool eventually(const Condition& condition, double seconds = 20);

}  // namespace edgepose::test

#include <chrono>
#include <thread>

template <class Condition>
bool edgepose::test::eventually(const Condition& condition, double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return true;
}
