#include "servoing/servo_state.h"

#include <gtest/gtest.h>

#include <array>

namespace edgepose {
namespace {

using enum ServoState;

TEST(ServoState, TableIsTheDocumentedOne) {
  constexpr std::nullopt_t x = std::nullopt;
  //                                                    arm   go            stop      reset  standoff touched
  //                                                    failed
  const std::array<std::array<std::optional<ServoState>, 7>, 7> expected = {
      {{kArmed, x, kIdle, kIdle, x, x, kFault},
       {x, kApproaching, kStopped, kIdle, x, x, kFault},
       {x, x, kStopped, x, kAxial, x, kFault},
       {x, x, kStopped, x, x, kConverged, kFault},
       {x, x, kStopped, kIdle, x, x, kFault},
       {x, x, kStopped, kIdle, x, x, kFault},
       {x, x, kFault, kIdle, x, x, kFault}}};
  for (int state = 0; state < kServoStates; ++state)
    for (int event = 0; event < kServoEvents; ++event)
      EXPECT_EQ(transition(static_cast<ServoState>(state), static_cast<ServoEvent>(event)),
                expected[state][event])
          << state_name(static_cast<ServoState>(state)) << ", " << event_name(static_cast<ServoEvent>(event));
}

/// Shortest number of events that lead from `from` to a state in which the arm may move, never taking
/// `without`.
int events_to_motion(ServoState from, ServoEvent without) {
  std::array<int, kServoStates> distance;
  distance.fill(-1);
  distance[static_cast<size_t>(from)] = 0;
  for (int round = 0; round < kServoStates; ++round)
    for (int state = 0; state < kServoStates; ++state)
      for (int event = 0; event < kServoEvents; ++event) {
        if (distance[state] != round || static_cast<ServoEvent>(event) == without) continue;
        const auto next = transition(static_cast<ServoState>(state), static_cast<ServoEvent>(event));
        if (!next || distance[static_cast<size_t>(*next)] >= 0) continue;
        distance[static_cast<size_t>(*next)] = round + 1;
        if (may_move(*next)) return round + 1;
      }
  return -1;
}

TEST(ServoState, NothingMovesWithoutArmAndGo) {
  EXPECT_EQ(events_to_motion(kIdle, ServoEvent::kStop), 2);
  EXPECT_EQ(events_to_motion(kIdle, ServoEvent::kArm), -1);
  EXPECT_EQ(events_to_motion(kIdle, ServoEvent::kGo), -1);
}

TEST(ServoState, NothingMovesAgainWithoutReset) {
  for (const ServoState state : {kConverged, kStopped, kFault}) {
    EXPECT_EQ(events_to_motion(state, ServoEvent::kReset), -1) << state_name(state);
    EXPECT_EQ(events_to_motion(state, ServoEvent::kArm), -1) << state_name(state);
    EXPECT_EQ(events_to_motion(state, ServoEvent::kStop), 3) << state_name(state);
  }
}

TEST(ServoState, FaultIsLeftByResetOnly) {
  for (int event = 0; event < kServoEvents; ++event) {
    if (static_cast<ServoEvent>(event) == ServoEvent::kReset) continue;
    EXPECT_EQ(transition(kFault, static_cast<ServoEvent>(event)).value_or(kFault), kFault);
  }
}

}  // namespace
}  // namespace edgepose
