/// How late loops of 5 ms that do nothing begin, one on each processor, and whichever of them is the first:
/// what the machine allows. In milliseconds. Usage: edgepose_cycle_floor SECONDS
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <vector>

#include "bus/steady_clock.h"
#include "daemon/real_time.h"

namespace edgepose {
namespace {

constexpr int64_t kCycle = 5'000'000, kSecond = 1'000'000'000;  // [ns]
constexpr int kFirst = 80;                                      // priority: before all of the programs

/// [ns] by which each cycle began late.
using Lateness = std::vector<int64_t>;

void run(size_t processor, int64_t begin_ns, Lateness& late, std::string& fault) {
  fault = stay_on(processor);
  if (fault.empty()) fault = become_real_time(kFirst);
  for (size_t i = 0; i < late.size(); ++i) {
    const int64_t deadline = begin_ns + static_cast<int64_t>(i) * kCycle;
    sleep_until(deadline);
    late[i] = steady_ns() - deadline;
  }
}

void print(const std::string& what, Lateness late, const std::string& fault) {
  std::sort(late.begin(), late.end());
  const auto ms = [&](double share) {
    return 1e-6 *
           static_cast<double>(late[static_cast<size_t>(share * static_cast<double>(late.size() - 1))]);
  };
  std::printf("%s p50 %.3f p99.9 %.3f worst %.3f %s\n", what.c_str(), ms(0.5), ms(0.999), ms(1),
              fault.c_str());
}

void measure(int64_t seconds) {
  const std::vector<size_t> processors = allowed_processors();
  std::vector<Lateness> late(processors.size(), Lateness(static_cast<size_t>(seconds * kSecond / kCycle)));
  std::vector<std::string> faults(processors.size());
  std::vector<std::thread> threads;
  const int64_t begin_ns = steady_ns() + kSecond / 10;
  for (size_t i = 0; i < processors.size(); ++i)
    threads.emplace_back(run, processors[i], begin_ns, std::ref(late[i]), std::ref(faults[i]));
  for (std::thread& thread : threads) thread.join();
  Lateness first = late.front();
  for (const Lateness& one : late)
    std::transform(first.begin(), first.end(), one.begin(), first.begin(),
                   [](int64_t a, int64_t b) { return std::min(a, b); });
  print("first", first, faults.front());
  for (size_t i = 0; i < processors.size(); ++i)
    print("processor_" + std::to_string(processors[i]), late[i], faults[i]);
}

}  // namespace
}  // namespace edgepose

int main(int argc, char** argv) {
  const long seconds = argc == 2 ? std::atol(argv[1]) : 0;
  if (seconds < 1) {
    std::fputs("usage: edgepose_cycle_floor SECONDS\n", stderr);
    return 2;
  }
  edgepose::measure(seconds);
  return 0;
}
