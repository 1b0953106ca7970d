#include "experiment/experiment.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <numbers>
#include <thread>

#include "common/error.h"
#include "matcher/option_range.h"

namespace edgepose {
namespace {

struct Job {
  size_t arm;
  uint64_t seed;
};

bool is_done(const ArmResults& results, uint64_t seed) {
  return std::any_of(results.trials.begin(), results.trials.end(),
                     [&](const TrialResult& trial) { return trial.seed == seed; });
}

std::vector<Job> open_jobs(const ExperimentOptions& options, const std::vector<ArmResults>& done) {
  std::vector<Job> jobs;
  // Seed after seed, so that an experiment that is cut short has as many of each arm.
  for (int i = 0; i < options.trials; ++i)
    for (size_t arm = 0; arm < options.arms.size(); ++arm) {
      const uint64_t seed = options.first_seed + static_cast<uint64_t>(i);
      if (!is_done(done[arm], seed)) jobs.push_back({arm, seed});
    }
  return jobs;
}

}  // namespace

std::vector<ExperimentArm> standard_arms() {
  const ToldNoise none = ToldNoise::none();
  ExperimentArm touched{"D5 taught at 5 others, touch 0.3 mm, 0.1 degrees", GoalKind::kTaughtFive, {}};
  touched.touch = 0.0003;
  touched.touch_angle = 0.1 * std::numbers::pi / 180;
  return {{"A one shot, goal from calibrations", GoalKind::kOneShot, {}},
          {"B closed loop, goal from calibrations", GoalKind::kCalibrated, {}},
          {"C exact goal, no noise", GoalKind::kExact, none},
          {"C exact goal", GoalKind::kExact, {}},
          {"D1 taught at the hole", GoalKind::kTaughtOne, {}},
          {"D5 taught at 5 others", GoalKind::kTaughtFive, {}},
          touched};
}

std::string ExperimentOptions::check() const {
  if (arms.empty()) return "arms: expected at least one, found none";
  if (const std::string fault = trial.check(); !fault.empty()) return fault;
  return option_fault(
      {{"trials", static_cast<double>(trials), 1, 1e6}, {"threads", static_cast<double>(threads), 0, 256}});
}

std::vector<ArmResults> run_experiment(const WorkCell& cell, const ExperimentOptions& options,
                                       std::vector<ArmResults> done, const TrialNote& note,
                                       const std::stop_token& stop) {
  if (const std::string fault = options.check(); !fault.empty()) throw InputError("experiment: " + fault);
  if (done.empty())
    for (const ExperimentArm& arm : options.arms) done.push_back({arm, {}});
  const ModelHandle model = trained_model(cell);
  const std::vector<Job> jobs = open_jobs(options, done);
  std::atomic<size_t> next = 0;
  std::mutex mutex;
  std::exception_ptr failure;  // guarded by mutex, as done
  const auto work = [&] {
    for (size_t i = next++; i < jobs.size() && !stop.stop_requested(); i = next++) {
      try {
        const TrialResult result =
            run_trial(cell, model, options.arms[jobs[i].arm], jobs[i].seed, options.trial);
        const std::scoped_lock lock(mutex);
        done[jobs[i].arm].trials.push_back(result);
        note(options.arms[jobs[i].arm], result);
      } catch (...) {
        const std::scoped_lock lock(mutex);
        if (!failure) failure = std::current_exception();
        next = jobs.size();
      }
    }
  };
  const unsigned cores = std::max(1u, std::thread::hardware_concurrency());
  std::vector<std::jthread> threads;
  for (unsigned i = 1; i < (options.threads == 0 ? cores : static_cast<unsigned>(options.threads)); ++i)
    threads.emplace_back(work);
  work();
  threads.clear();
  if (failure) std::rethrow_exception(failure);
  for (ArmResults& arm : done)
    std::sort(arm.trials.begin(), arm.trials.end(),
              [](const TrialResult& a, const TrialResult& b) { return a.seed < b.seed; });
  return done;
}

}  // namespace edgepose
