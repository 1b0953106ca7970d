#pragma once

namespace edgepose {

/// Why the main thread wakes up.
enum class Wake { kTick, kEnd, kReload };

/// SIGTERM, SIGINT and SIGHUP as events of the main thread; blocked for all threads that are made afterwards.
class Signals {
 public:
  Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  ~Signals();

  /// Waits for a signal, for end(), or for the next tick, one each `period` milliseconds.
  Wake wait(int period);
  /// As SIGTERM; from any thread.
  void end();

 private:
  int signals_ = -1, ending_ = -1, timer_ = -1;
};

}  // namespace edgepose
