// What each way to a goal can reach, with ideal correspondences: the table of docs/servoing.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>

#include "tests/servoing/positioning_trial.h"

namespace edgepose {
namespace {

constexpr int kTrials = 200;
constexpr ToldNoise kNone{0, 0, 0}, kNoIntrinsics{0, 0, 0.01};

struct Summary {
  double median = 0, p95 = 0, most = 0;  ///< [mm] of the tip
  double median_deg = 0, p95_deg = 0, most_deg = 0;
  double within = 0, within_low = 0,
         within_high = 0;  ///< share within 1 mm and 1 degree, 95 % Wilson interval
  int steps = 0;           ///< most, of those that converged
  int not_converged = 0;
};

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1];
}

void set_wilson(Summary& summary, int hits) {
  constexpr double z = 1.959964, n = kTrials;
  const double p = hits / n, middle = (p + z * z / (2 * n)) / (1 + z * z / n);
  const double half = z / (1 + z * z / n) * std::sqrt(p * (1 - p) / n + z * z / (4 * n * n));
  summary.within = p;
  summary.within_low = std::max(0.0, middle - half);
  summary.within_high = std::min(1.0, middle + half);
}

Summary measure(const char* name, const TrialSetup& setup) {
  std::vector<double> millimetres, degrees;
  Summary summary;
  int hits = 0;
  for (uint64_t seed = 1; seed <= kTrials; ++seed) {
    const TrialResult trial = positioning_trial(setup, seed);
    millimetres.push_back(trial.error.translation * 1e3);
    degrees.push_back(trial.error.rotation * 180 / M_PI);
    hits += millimetres.back() <= 1 && degrees.back() <= 1;
    if (trial.steps > 20)
      ++summary.not_converged;
    else
      summary.steps = std::max(summary.steps, trial.steps);
  }
  summary.median = quantile(millimetres, 0.5);
  summary.p95 = quantile(millimetres, 0.95);
  summary.most = quantile(millimetres, 1);
  summary.median_deg = quantile(degrees, 0.5);
  summary.p95_deg = quantile(degrees, 0.95);
  summary.most_deg = quantile(degrees, 1);
  set_wilson(summary, hits);
  std::printf("| %-52s | %.3g | %.3g | %.3g | %.2f | %.2f | %.2f | %.1f %% (%.1f to %.1f) | %d |\n", name,
              summary.median, summary.p95, summary.most, summary.median_deg, summary.p95_deg,
              summary.most_deg, 100 * summary.within, 100 * summary.within_low, 100 * summary.within_high,
              summary.steps);
  return summary;
}

TrialSetup setup(GoalSource source, ToldNoise noise = {}, double distance = 0.35) {
  TrialSetup result;
  result.source = source;
  result.noise = noise;
  result.distance = distance;
  return result;
}

TrialSetup taught(GoalSource source, double touch_sigma) {
  TrialSetup result = setup(source);
  result.touch_sigma = touch_sigma;
  result.touch_angle_sigma = touch_sigma * 6;  // 0.1 degrees for 0.3 mm
  return result;
}

TEST(MonteCarlo, GoalsFromCalibrationsMissByTheCalibrationsErrors) {
  const Summary one_shot = measure("A one shot, goal from calibrations", setup(GoalSource::kOneShot));
  const Summary closed = measure("B closed loop, goal from calibrations", setup(GoalSource::kCalibrated));
  EXPECT_NEAR(one_shot.median, 22, 4);
  EXPECT_NEAR(closed.median, 22, 4);
  EXPECT_LT(one_shot.within, 0.05);
  EXPECT_LT(closed.within, 0.05);
  EXPECT_EQ(closed.not_converged, 0) << "the loop itself ends at its goal; the goal is wrong";
}

TEST(MonteCarlo, ExactGoalIsReachedWhateverTheHandEye) {
  const Summary none = measure("C exact goal, no noise", setup(GoalSource::kExact, kNone));
  EXPECT_EQ(none.within, 1);
  EXPECT_LT(none.most, 0.3);
  EXPECT_LT(none.most_deg, 0.2);
  const Summary noisy =
      measure("C exact goal, noise of hand-eye and tool only", setup(GoalSource::kExact, kNoIntrinsics));
  EXPECT_EQ(noisy.within, 1);
  EXPECT_LT(noisy.most, 0.3);
  EXPECT_LE(noisy.steps, 6);
}

TEST(MonteCarlo, WrongIntrinsicsSpoilTheExactGoalMoreTheFartherAway) {
  const Summary near = measure("C exact goal, all noise, 0.22 m", setup(GoalSource::kExact, {}, 0.22));
  const Summary middle = measure("C exact goal, all noise, 0.35 m", setup(GoalSource::kExact, {}, 0.35));
  const Summary far = measure("C exact goal, all noise, 0.50 m", setup(GoalSource::kExact, {}, 0.5));
  EXPECT_LT(near.median, middle.median);
  EXPECT_LT(middle.median, far.median);
  EXPECT_NEAR(middle.median, 0.95, 0.3);
  EXPECT_LT(far.within, near.within);
}

TEST(MonteCarlo, TaughtGoalReachesAMillimetre) {
  const Summary same =
      measure("D1 taught at the hole itself, perfect touch", taught(GoalSource::kTaughtSame, 0));
  EXPECT_LT(same.most, 0.01);
  const Summary five = measure("D5 taught on 5 others, perfect touch", taught(GoalSource::kTaughtOther, 0));
  EXPECT_GE(five.within_low, 0.9);
  const Summary touched_one =
      measure("D1 ... touch 0.3 mm, 0.1 degrees (sigma)", taught(GoalSource::kTaughtSame, 0.0003));
  const Summary touched_five =
      measure("D5 ... touch 0.3 mm, 0.1 degrees (sigma)", taught(GoalSource::kTaughtOther, 0.0003));
  EXPECT_GE(touched_five.within_low, 0.9);
  EXPECT_GT(touched_one.p95, touched_five.p95) << "five references average the error of the touch";
}

}  // namespace
}  // namespace edgepose
