#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/live_options.h"
#include "server/registry.h"
#include "server/training_request.h"

namespace edgepose {

/// The thread that registers models, one after the other, beside the matching.
class Registrar {
 public:
  struct Order {
    TrainingRequest request;
    bool replace = false;
    /// Called on the registrar's thread: when it is registered, or with what went wrong (then `model` is
    /// null).
    std::function<void(const ModelHandle& model, const TrainingResult& result, std::exception_ptr failure)>
        done;
  };

  Registrar(Registry& registry, const LiveOptions& options);
  Registrar(const Registrar&) = delete;
  Registrar& operator=(const Registrar&) = delete;
  ~Registrar();  ///< the one at hand is ended, what waits is dropped

  /// False if too many wait already.
  bool post(Order order);
  /// Names that are being trained or wait for it.
  std::vector<std::string> pending() const;

 private:
  void run();
  void work_on(const Order& order);

  Registry& registry_;
  const LiveOptions& options_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Order> orders_;  // the first is being worked on
  std::atomic<bool> stopping_ = false;
  std::thread thread_;
};

/// The name is taken, and the order does not replace it.
class NameTaken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace edgepose
