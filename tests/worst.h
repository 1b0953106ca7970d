#pragma once
#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>

namespace edgepose::test {

/// The worst of what was measured over the repetitions, printed at the end: the table of
/// docs/servo_faults.md.
class Worst {
 public:
  explicit Worst(std::string what) : what_(std::move(what)) {}
  Worst(const Worst&) = delete;
  Worst& operator=(const Worst&) = delete;
  ~Worst() { std::printf("| %s | %d | %g |\n", what_.c_str(), count_, worst_); }
  void add(double value) {
    worst_ = count_ == 0 ? value : std::max(worst_, value);
    ++count_;
  }

 private:
  std::string what_;
  int count_ = 0;
  double worst_ = 0;
};

}  // namespace edgepose::test
