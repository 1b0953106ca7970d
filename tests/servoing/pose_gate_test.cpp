#include "servoing/pose_gate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/servoing/rig.h"

namespace edgepose {
namespace {

constexpr double kNow = 100;

PoseReading good() {
  PoseReading reading;
  reading.sequence = 7;
  reading.capture_time = kNow - 0.1;
  reading.accepted = true;
  reading.score = 0.9;
  reading.covariance.diagonal() << 1e-6, 1e-6, 1e-6, 1e-8, 1e-8, 1e-8;
  reading.camera_T_model.translation() << 0.01, 0.02, 0.35;
  return reading;
}

/// Of a fresh gate, the model expected where good() has it.
PoseVerdict judged(const PoseReading& reading, bool arm_known = true) {
  PoseGate gate{PoseGateOptions()};
  const PoseVerdict verdict = gate.judge(reading, kNow, arm_known, good().camera_T_model);
  EXPECT_EQ(gate.count(verdict), 1);
  return verdict;
}

TEST(PoseGate, TakesAGoodPose) { EXPECT_EQ(judged(good()), PoseVerdict::kTaken); }

TEST(PoseGate, RefusesWhatIsNoPose) {
  PoseReading reading = good();
  reading.camera_T_model.translation().x() = std::nan("");
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper);
  reading = good();
  reading.camera_T_model.linear() *= 1.001;
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper) << "scaled";
  reading = good();
  reading.camera_T_model.linear().col(0) *= -1;
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper) << "mirrored";
  reading = good();
  reading.camera_T_model.linear().setZero();
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper) << "what a quaternion of zeros gives";
  reading = good();
  reading.covariance(2, 3) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper);
  reading = good();
  reading.score = std::nan("");
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper);
  reading = good();
  reading.capture_time = std::nan("");
  EXPECT_EQ(judged(reading), PoseVerdict::kNotProper);
}

TEST(PoseGate, RefusesWhatIsOldOrFromTheFuture) {
  PoseReading reading = good();
  reading.capture_time = kNow - 0.41;
  EXPECT_EQ(judged(reading), PoseVerdict::kStale);
  reading.capture_time = kNow - 0.39;
  EXPECT_EQ(judged(reading), PoseVerdict::kTaken);
  reading.capture_time = kNow + 0.02;
  EXPECT_EQ(judged(reading), PoseVerdict::kFromFuture);
  reading.capture_time = kNow + 0.005;
  EXPECT_EQ(judged(reading), PoseVerdict::kTaken);
}

TEST(PoseGate, TakesEachFrameOnceAndNoneBackwards) {
  PoseGate gate{PoseGateOptions()};
  PoseReading reading = good();
  EXPECT_EQ(gate.judge(reading, kNow, true, {}), PoseVerdict::kTaken);
  EXPECT_EQ(gate.judge(reading, kNow, true, {}), PoseVerdict::kNotNew) << "the same again";
  reading.capture_time += 0.01;
  EXPECT_EQ(gate.judge(reading, kNow, true, {}), PoseVerdict::kNotNew) << "old number, new time";
  reading.sequence = 8;
  reading.capture_time = good().capture_time;
  EXPECT_EQ(gate.judge(reading, kNow, true, {}), PoseVerdict::kNotNew) << "new number, old time";
  reading.capture_time += 0.01;
  EXPECT_EQ(gate.judge(reading, kNow, true, {}), PoseVerdict::kTaken);
  EXPECT_EQ(gate.count(PoseVerdict::kTaken), 2);
  EXPECT_EQ(gate.count(PoseVerdict::kNotNew), 3);
}

TEST(PoseGate, ARefusedPoseDoesNotMakeLaterOnesOld) {
  PoseGate gate{PoseGateOptions()};
  PoseReading far_ahead = good();
  far_ahead.sequence = 1000000;
  far_ahead.accepted = false;
  EXPECT_EQ(gate.judge(far_ahead, kNow, true, {}), PoseVerdict::kNotAccepted);
  EXPECT_EQ(gate.judge(good(), kNow, true, {}), PoseVerdict::kTaken);
}

TEST(PoseGate, RefusesWhatTheServiceIsNotSureOf) {
  PoseReading reading = good();
  reading.accepted = false;
  EXPECT_EQ(judged(reading), PoseVerdict::kNotAccepted);
  reading = good();
  reading.score = 0.65;
  EXPECT_EQ(judged(reading), PoseVerdict::kLowScore);
  reading = good();
  reading.covariance(5, 5) = 2.1e-3 * 2.1e-3;
  EXPECT_EQ(judged(reading), PoseVerdict::kUncertain) << "position";
  reading = good();
  reading.covariance(0, 0) = 0.021 * 0.021;
  EXPECT_EQ(judged(reading), PoseVerdict::kUncertain) << "rotation";
  reading = good();
  reading.covariance.setZero();
  EXPECT_EQ(judged(reading), PoseVerdict::kUncertain) << "not known";
}

TEST(PoseGate, RefusesJumps) {
  const auto moved = [](double metres) {
    PoseReading reading = good();
    reading.camera_T_model.translation().y() += metres;
    return reading;
  };
  const auto turned = [](double radians) {
    PoseReading reading = good();
    reading.camera_T_model.linear() = rotation_matrix(Eigen::Vector3d(radians, 0, 0));
    return reading;
  };
  EXPECT_EQ(judged(moved(0.05)), PoseVerdict::kJumped);
  EXPECT_EQ(judged(moved(0.019)), PoseVerdict::kTaken);
  EXPECT_EQ(judged(turned(20 * M_PI / 180)), PoseVerdict::kJumped);
  EXPECT_EQ(judged(turned(M_PI)), PoseVerdict::kJumped);
  EXPECT_EQ(judged(turned(0.14)), PoseVerdict::kTaken);
  PoseGate first{PoseGateOptions()};
  EXPECT_EQ(first.judge(moved(0.05), kNow, true, {}), PoseVerdict::kTaken) << "nothing is expected yet";
}

TEST(PoseGate, RefusesAPoseOfWhichTheArmsPlaceIsNotKnown) {
  EXPECT_EQ(judged(good(), false), PoseVerdict::kNoArmPose);
}

TEST(PoseGate, NamesItsVerdictsAndFaults) {
  EXPECT_STREQ(verdict_name(PoseVerdict::kTaken), "taken");
  EXPECT_STREQ(verdict_name(PoseVerdict::kJumped), "jumped");
  EXPECT_EQ(PoseGateOptions().check(), "");
  PoseGateOptions options;
  options.min_score = 2;
  EXPECT_EQ(options.check().substr(0, 15), "gate.min_score:");
}

}  // namespace
}  // namespace edgepose
