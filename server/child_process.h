#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <vector>

namespace edgepose {

/// What a child process may use.
struct ChildLimits {
  uint64_t memory_bytes = 0;                ///< of address space; 0 = no limit
  double seconds = 0;                       ///< wall time
  const std::atomic<bool>* stop = nullptr;  ///< set by another thread: the child is killed
};

/// Exit code of a child that could not become this program.
inline constexpr int kCouldNotStart = 127;

/// How a child process ended.
struct ChildEnd {
  bool timed_out = false;  ///< it was killed for it
  bool stopped = false;    ///< it was killed because it was told to stop
  int exit_code = -1;      ///< -1: by a signal
  int signal = 0;
  std::string out, err;  ///< what it printed, the first 256 KiB of each
};

/// Runs this program anew with `arguments`, at a low priority and without anything open but its three
/// streams; `input` is what it reads. It dies with this process, and leaves no core file. Throws
/// std::system_error if it cannot be started.
ChildEnd run_self(const std::vector<std::string>& arguments, const std::string& input,
                  const ChildLimits& limits);

}  // namespace edgepose
