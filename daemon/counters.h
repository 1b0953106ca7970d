#pragma once
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace edgepose {

/// How often something has happened, by name; what became of every frame, message and request. Safe from any
/// thread. Names are the program's own, never from outside, so that their number is bounded.
class Counters {
 public:
  void add(const std::string& name, uint64_t count = 1) {
    const std::scoped_lock lock(mutex_);
    values_[name] += count;
  }
  uint64_t get(const std::string& name) const {
    const std::scoped_lock lock(mutex_);
    const auto found = values_.find(name);
    return found == values_.end() ? 0 : found->second;
  }
  std::map<std::string, uint64_t> all() const {
    const std::scoped_lock lock(mutex_);
    return values_;
  }

 private:
  mutable std::mutex mutex_;
  std::map<std::string, uint64_t> values_;
};

}  // namespace edgepose
