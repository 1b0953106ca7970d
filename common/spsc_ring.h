#pragma once
#include <atomic>
#include <cstdint>
#include <vector>

namespace edgepose {

/// A queue between one thread that puts and one that takes; neither ever waits or allocates. What does not
/// fit is dropped and counted.
template <class Item>
class SpscRing {
 public:
  /// Memory for `capacity` items is taken here.
  explicit SpscRing(size_t capacity) : items_(capacity + 1) {}

  /// False if it was full.
  bool push(const Item& item) {
    const size_t at = put_.load(std::memory_order_relaxed);
    const size_t next = at + 1 == items_.size() ? 0 : at + 1;
    if (next == taken_.load(std::memory_order_acquire)) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[at] = item;
    put_.store(next, std::memory_order_release);
    return true;
  }
  /// False if it was empty.
  bool pop(Item& item) {
    const size_t at = taken_.load(std::memory_order_relaxed);
    if (at == put_.load(std::memory_order_acquire)) return false;
    item = items_[at];
    taken_.store(at + 1 == items_.size() ? 0 : at + 1, std::memory_order_release);
    return true;
  }
  uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

 private:
  std::vector<Item> items_;
  std::atomic<size_t> put_ = 0, taken_ = 0;
  std::atomic<uint64_t> dropped_ = 0;
};

}  // namespace edgepose
