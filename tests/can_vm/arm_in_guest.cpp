#include "tests/can_vm/arm_in_guest.h"

#include <chrono>
#include <cmath>
#include <thread>

#include "bus/steady_clock.h"
#include "tests/real_time.h"

namespace edgepose::test {
namespace {

constexpr int64_t kOld = 60'000'000'000;  // [ns]: a pair's truth is in the guest's memory

/// [ns] for which the simulated drives did not run, at most, in the stop that was looked at last: they should
/// have processors of their own, and have to share the guest's.
int64_t longest_gap_ns = 0;

}  // namespace

void ArmInGuest::SetUpTestSuite() {
  has_can_ = enter_own_network() && run("ip link add vcan0 type vcan") && run("ip link set vcan0 up");
}

void ArmInGuest::TearDownTestSuite() {
  end();
  run("ip link del vcan0");
}

void ArmInGuest::SetUp() {
  if (!has_can_) GTEST_SKIP() << "NOT TESTED: no CAN in this kernel; run it by tests/can_vm/can_vm_test.sh";
}

void ArmInGuest::pause(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void ArmInGuest::start() {
  end();
  ways_ = 0;
  arm_ = std::make_unique<ArmProcesses>(++pairs_, std::vector<std::string>{}, servo_options_, "vcan0");
  started_ns_ = steady_ns();
}

ArmProcesses& ArmInGuest::moving_anew(std::vector<std::string> servo) {
  end();
  pairs_ = 0;
  servo_options_ = std::move(servo);
  ArmProcesses& arm = moving();
  servo_options_.clear();
  return arm;
}

void ArmInGuest::set_out_again() {
  if (arm_->controller().wait(0)) arm_->start_controller();
  if (arm_->state() != "idle") {
    arm_->servo("stop");
    eventually([] { return arm_->state() == "stopped" || arm_->state() == "fault"; }, 5);
    // Refused until it is at rest.
    eventually(
        [] {
          try {
            arm_->servo("reset");
          } catch (const std::runtime_error&) {
          }
          return arm_->state() == "idle";
        },
        5);
  }
  // To the one hole and then to the other: there is mostly a way to go.
  arm_->set_out(++ways_ % 2 == 1 ? kHole : "right_pedicle_screw");
  if (!is_moving()) throw std::runtime_error("it is there already");
}

/// As the controller measures its joints.
bool ArmInGuest::is_moving() {
  const auto joints = [] { return arm_->servo("status")["joints_rad"].get<std::vector<double>>(); };
  const std::vector<double> before = joints();
  pause(0.03);
  const std::vector<double> now = joints();
  double most = 0;
  for (size_t i = 0; i < now.size(); ++i) most = std::max(most, std::abs(now[i] - before[i]));
  return most > 0.03 * 0.01;  // 0.01 rad/s
}

ArmProcesses& ArmInGuest::moving() {
  std::string cause;
  for (int attempt = 0; attempt < 5; ++attempt) {
    try {
      if (!arm_ || attempt > 1 || !servo_options_.empty() || steady_ns() - started_ns_ > kOld) start();
      set_out_again();
      return *arm_;
    } catch (const std::runtime_error& error) {  // a machine too busy, which faults a drive
      cause = error.what();
      std::printf("[repeated] %s\n", cause.c_str());
    }
  }
  throw std::runtime_error("the arm does not set out: " + cause);
}

void ArmInGuest::repeat(const std::string& name, const std::vector<Worst*>& figures,
                        const std::function<std::vector<double>(ArmProcesses&, BusRecord&)>& trial) {
  for (int i = process_repetitions(1); i > 0 && !HasFailure(); --i) {
    std::vector<double> measured;
    in_real_time(
        name, kBusy,
        [&](int64_t& late_ns) {
          ArmProcesses& arm = moving();
          BusRecord record(trace_file("arm_" + name + ".pcap"));
          longest_gap_ns = 0;
          {
            const Lateness lateness(late_ns);
            pause(0.05);  // the record has what was before
            measured = trial(arm, record);
          }
          late_ns = std::max(late_ns, longest_gap_ns);
        },
        [] {});
    for (size_t k = 0; k < figures.size() && k < measured.size(); ++k) figures[k]->add(measured[k]);
  }
}

bool is_at_rest(const TruthLine& line) { return line.fastest() < 1e-4; }

std::vector<double> expect_stop(const ArmProcesses& arm, int64_t from_ns, double stop_within,
                                double rest_within) {
  const std::vector<TruthLine> truth = arm.read_truth(from_ns - 20 * kMillisecond);
  if (truth.empty()) throw std::runtime_error("no truth");
  EXPECT_FALSE(is_at_rest(truth.front())) << "nothing to stop";
  EXPECT_FALSE(truth.front().stops());
  for (size_t i = 1; i < truth.size(); ++i)
    longest_gap_ns = std::max(longest_gap_ns, truth[i].time_ns - truth[i - 1].time_ns - kMillisecond);
  const double to_stop = ms_until(truth, from_ns, [](const TruthLine& line) { return line.stops(); });
  const double to_rest = ms_until(truth, from_ns, is_at_rest);
  EXPECT_THAT(to_stop, testing::AllOf(testing::Ge(0), testing::Le(stop_within)));
  EXPECT_THAT(to_rest, testing::AllOf(testing::Ge(0), testing::Le(rest_within)));
  return {to_stop, to_rest};
}

int64_t await_fault(ArmProcesses& arm, const std::string& text) {
  EXPECT_TRUE(eventually([&] { return arm.state() == "fault"; }, 3));
  const int64_t seen = steady_ns();
  EXPECT_THAT(arm.servo("status")["fault"].get<std::string>(), testing::HasSubstr(text));
  return seen;
}

}  // namespace edgepose::test
