#include "canopen/cia402.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace edgepose {
namespace {

using enum DriveState;

struct Row {
  DriveState state;
  uint16_t mask, bits;
};

/// CiA 402-2, "statusword and PDS FSA states".
const std::vector<Row> kTable{
    {kNotReady, 0x4f, 0x00},
    {kSwitchOnDisabled, 0x4f, 0x40},
    {kReadyToSwitchOn, 0x6f, 0x21},
    {kSwitchedOn, 0x6f, 0x23},
    {kOperationEnabled, 0x6f, 0x27},
    {kQuickStopActive, 0x6f, 0x07},
    {kFaultReactionActive, 0x4f, 0x0f},
    {kFault, 0x4f, 0x08},
};

TEST(Cia402, EveryStatuswordIsWhatTheTableSays) {
  int known = 0;
  for (unsigned word = 0; word <= 0xffff; ++word) {
    DriveState expected = kUnknown;
    for (const Row& row : kTable)
      if ((word & row.mask) == row.bits) expected = row.state;
    ASSERT_EQ(state_of(static_cast<uint16_t>(word)), expected) << word;
    known += expected != kUnknown;
  }
  // Four states leave 11 bits open out of 5-bit masks (4F), four leave 10 (6F).
  EXPECT_EQ(known, 4 * (1 << 11) + 4 * (1 << 10));
}

TEST(Cia402, StateBitsAreReadBack) {
  for (const Row& row : kTable) EXPECT_EQ(state_of(state_bits(row.state)), row.state) << name_of(row.state);
}

TEST(Cia402, TheWayToOperationEnabled) {
  DriveState state = kSwitchOnDisabled;
  uint16_t before = 0;
  std::vector<uint16_t> words;
  while (state != kOperationEnabled && words.size() < 10) {
    const uint16_t word = controlword_towards_enabled(state);
    const DriveState expected = next_state_towards_enabled(state);
    state = after_controlword(state, word, before);
    EXPECT_EQ(state, expected);
    before = word;
    words.push_back(word);
  }
  EXPECT_EQ(words, (std::vector<uint16_t>{0x06, 0x07, 0x0f}));
}

TEST(Cia402, QuickStopFromEachState) {
  EXPECT_EQ(after_controlword(kOperationEnabled, 0x02, 0x0f), kQuickStopActive);
  EXPECT_EQ(after_controlword(kSwitchedOn, 0x02, 0x07), kSwitchOnDisabled);
  EXPECT_EQ(after_controlword(kReadyToSwitchOn, 0x02, 0x06), kSwitchOnDisabled);
  EXPECT_EQ(after_controlword(kFault, 0x02, 0x0f), kFault);
  EXPECT_EQ(after_controlword(kQuickStopActive, 0x0f, 0x02), kQuickStopActive)
      << "not straight back (transition 16)";
  EXPECT_EQ(after_controlword(kQuickStopActive, 0x00, 0x02), kSwitchOnDisabled);
}

TEST(Cia402, FaultsAreResetByARisingEdgeOnly) {
  EXPECT_EQ(after_controlword(kFault, 0x80, 0x80), kFault);
  EXPECT_EQ(after_controlword(kFault, 0x80, 0x00), kSwitchOnDisabled);
  EXPECT_EQ(after_controlword(kFault, 0x0f, 0x00), kFault);
  EXPECT_EQ(after_controlword(kFaultReactionActive, 0x80, 0x00), kFaultReactionActive);
}

TEST(Cia402, NoControlwordLeadsIntoPowerButTheThreeInTheirOrder) {
  for (unsigned word = 0; word <= 0xffff; ++word) {
    const auto is = static_cast<uint16_t>(word);
    EXPECT_NE(after_controlword(kSwitchOnDisabled, is, 0), kOperationEnabled);
    EXPECT_NE(after_controlword(kFault, is, 0), kOperationEnabled);
    EXPECT_NE(after_controlword(kQuickStopActive, is, 0), kOperationEnabled);
    if (after_controlword(kSwitchedOn, is, 0) == kOperationEnabled) {
      EXPECT_EQ(is & 0x8f, 0x0f);
    }
  }
}

TEST(Cia402, EveryStateHasTheStandardsName) {
  EXPECT_STREQ(name_of(kSwitchOnDisabled), "switch on disabled");
  EXPECT_STREQ(name_of(state_of(0x1237)), "operation enabled");
  EXPECT_STREQ(name_of(state_of(0x0221 & ~0x20)), "no state of CiA 402");
}

}  // namespace
}  // namespace edgepose
