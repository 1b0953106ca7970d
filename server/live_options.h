#pragma once
#include <memory>
#include <mutex>

#include "server/service_options.h"

namespace edgepose {

/// The options in effect; SIGHUP puts others in their place. Safe from any thread.
class LiveOptions {
 public:
  explicit LiveOptions(ServiceOptions options)
      : options_(std::make_shared<const ServiceOptions>(std::move(options))) {}

  std::shared_ptr<const ServiceOptions> get() const {
    const std::scoped_lock lock(mutex_);
    return options_;
  }
  void set(ServiceOptions options) {
    auto next = std::make_shared<const ServiceOptions>(std::move(options));
    const std::scoped_lock lock(mutex_);
    options_ = std::move(next);
  }

 private:
  mutable std::mutex mutex_;
  std::shared_ptr<const ServiceOptions> options_;
};

}  // namespace edgepose
