#include "servoing/joint_history.h"

#include <gtest/gtest.h>

#include <cmath>

namespace edgepose {
namespace {

JointVector all(double value) { return JointVector::Constant(value); }

/// States every 5 ms from 0 to 1 s, all joints at the time's number.
JointHistory filled() {
  JointHistory history{JointHistoryOptions()};
  for (int i = 0; i <= 200; ++i) EXPECT_TRUE(history.add(i * 0.005, all(i * 0.005)));
  return history;
}

TEST(JointHistory, Interpolates) {
  const JointHistory history = filled();
  for (const double time : {0.0, 0.1234, 0.5, 0.9999, 1.0}) {
    ASSERT_TRUE(history.at(time)) << time;
    EXPECT_LT((*history.at(time) - all(time)).norm(), 1e-12);
  }
}

TEST(JointHistory, DoesNotGuessFarBeyondWhatWasMeasured) {
  const JointHistory history = filled();
  ASSERT_TRUE(history.at(1.009));
  EXPECT_EQ(*history.at(1.009), all(1.0)) << "where it was last";
  EXPECT_FALSE(history.at(1.011));
  EXPECT_FALSE(history.at(-0.001));
  EXPECT_FALSE(history.at(std::nan("")));
  EXPECT_FALSE(JointHistory{JointHistoryOptions()}.at(0));
}

TEST(JointHistory, DoesNotBridgeGaps) {
  JointHistory history = filled();
  ASSERT_TRUE(history.add(1.2, all(2)));
  EXPECT_FALSE(history.at(1.1));
  EXPECT_TRUE(history.at(0.999));
  EXPECT_TRUE(history.at(1.2));
}

TEST(JointHistory, ForgetsWhatIsOlderThanItsLength) {
  JointHistory history{JointHistoryOptions()};
  for (int i = 0; i <= 2000; ++i) history.add(i * 0.005, all(0));
  EXPECT_FALSE(history.at(7.9));
  EXPECT_TRUE(history.at(8.1));
  EXPECT_LE(history.size(), 402u);
}

TEST(JointHistory, RefusesStatesThatAreOldOrNone) {
  JointHistory history = filled();
  EXPECT_FALSE(history.add(1.0, all(5)));
  EXPECT_FALSE(history.add(0.5, all(5)));
  EXPECT_FALSE(history.add(std::nan(""), all(5)));
  EXPECT_FALSE(history.add(1.005, all(std::nan(""))));
  EXPECT_EQ(history.size(), 201u);
  EXPECT_EQ(*history.at(1.0), all(1.0));
}

TEST(JointHistory, NamesItsFault) {
  EXPECT_EQ(JointHistoryOptions().check(), "");
  JointHistoryOptions options;
  options.max_extrapolation = 1;
  EXPECT_EQ(options.check().substr(0, 26), "history.max_extrapolation:");
}

}  // namespace
}  // namespace edgepose
