/// How late a loop of 5 ms that does nothing begins on each processor: what no program on the machine can be
/// better than. Usage: edgepose_cycle_floor SECONDS
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
    fault = stay_on(number);
    if (fault.empty()) fault = become_real_time(kFirst);
    CycleClock clock(kCycle);
    clock.begin();
    CycleClock::Sleeper sleeper(clock);
    while (steady_ns() < end_ns) {
      if (const auto deadline = sleeper.wait()) {
        times.add(steady_ns() - *deadline, 0);
        clock.done(times);
      }
    }
  }
};

void measure(int64_t seconds) {
  std::vector<std::unique_ptr<Processor>> processors;
  const int64_t end_ns = steady_ns() + seconds * kSecond;
  for (const size_t i : allowed_processors()) {
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
