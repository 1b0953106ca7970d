/// How late a loop of 5 ms that does nothing begins on each processor: what no program on the machine can be
/// better than. Usage: edgepose_cycle_floor SECONDS
#include <sched.h>

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include "bus/steady_clock.h"
#include "controller/cycle_clock.h"
#include "daemon/real_time.h"

namespace edgepose {
namespace {

constexpr int64_t kCycle = 5'000'000, kSecond = 1'000'000'000;  // [ns]
constexpr int kFirst = 80;                                      // priority: before all of the programs

struct Processor {
  size_t number = 0;
  CycleTimes times;
  std::string fault;
  std::thread loop;

  void run(int64_t end_ns) {
    cpu_set_t only;
    CPU_ZERO(&only);
    CPU_SET(number, &only);
    sched_setaffinity(0, sizeof only, &only);
    fault = become_real_time(kFirst);
    CycleClock clock(kCycle);
    while (steady_ns() < end_ns) {
      const int64_t deadline = clock.wait(times);
      times.add(steady_ns() - deadline, 0);
    }
  }
};

void measure(int64_t seconds) {
  cpu_set_t allowed;
  sched_getaffinity(0, sizeof allowed, &allowed);
  std::vector<std::unique_ptr<Processor>> processors;
  const int64_t end_ns = steady_ns() + seconds * kSecond;
  for (size_t i = 0; i < CPU_SETSIZE; ++i) {
    if (!CPU_ISSET(i, &allowed)) continue;
    Processor& one = *processors.emplace_back(std::make_unique<Processor>());
    one.number = i;
    one.loop = std::thread([&one, end_ns] { one.run(end_ns); });
  }
  for (const auto& one : processors) {
    one->loop.join();
    std::printf("bare loop on processor %zu: late_p50_s %.6f late_p99.9_s %.6f late_worst_s %.6f %s\n",
                one->number, one->times.late(0.5), one->times.late(0.999), one->times.worst_late(),
                one->fault.c_str());
  }
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
