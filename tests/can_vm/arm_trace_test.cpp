// On the host, after arm_on_can_test in the guest: what edgepose-servo and edgepose-sim said on vcan0, as
// tshark understands it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "tests/canopen/tshark.h"

namespace edgepose {
namespace {

class ArmTrace : public testing::Test {
 protected:
  /// Decodes a capture of the guest; skips the test where there is none.
  void decode(const std::string& name) {
    const char* folder = std::getenv("EDGEPOSE_CAN_TRACES");
    const std::filesystem::path file = std::filesystem::path(folder ? folder : "") / (name + ".pcap");
    if (!folder || !Tshark::is_there() || !std::filesystem::exists(file))
      GTEST_SKIP()
          << "NOT TESTED: no capture from a vcan0, or no tshark; tests/can_vm/can_vm_test.sh makes one";
    trace = &kept(file);
    std::ifstream(std::filesystem::path(file).replace_extension("mark")) >> mark;
    for (const Tshark::Row& row : trace->rows()) ASSERT_FALSE(row.contains("_ws.malformed"));
    ASSERT_EQ(trace->count({{"cob_id", -1}}), trace->rows().size()) << "all is CANopen";
  }
  static double time_of(const Tshark::Row& row) {
    return std::strtod(row.at("frame.time_epoch").c_str(), nullptr);
  }
  /// Frames of `function` of any drive, before or from the mark on.
  size_t count(int function, bool after) const {
    size_t found = 0;
    for (const Tshark::Row& row : trace->rows()) {
      const int id = Tshark::number(row, "canopen.cob_id");
      const bool is_one = function == 0x080 ? id == 0x080 : (id & 0x780) == function && (id & 0x7f) != 0;
      found += is_one && (time_of(row) >= mark) == after;
    }
    return found;
  }

  const Tshark* trace = nullptr;
  double mark = 0;  ///< [s] of what befell, as the guest has noted

 private:
  static const Tshark& kept(const std::filesystem::path& file) {
    static std::map<std::string, Tshark> all;
    return all.try_emplace(file, file.string()).first->second;
  }
};

TEST_F(ArmTrace, EachNodeIsResetAndStartedOnceAndInThatOrder) {
  decode("arm_session");
  if (!trace) return;
  for (int node = 1; node <= 6; ++node) {
    std::vector<int> commands;
    for (const Tshark::Row& row : trace->rows())
      if (Tshark::number(row, "canopen.nmt_ctrl.node_id") == node)
        commands.push_back(Tshark::number(row, "canopen.nmt_ctrl.cd"));
    EXPECT_THAT(commands, testing::ElementsAre(0x82, 0x01)) << "reset communication, start: node " << node;
    EXPECT_GE(trace->count({{"nmt_guard.state", 0}, {"node_id", node}}), 1u) << "boot-up";
  }
}

TEST_F(ArmTrace, IdentitiesAreReadByUploads) {
  decode("arm_session");
  if (!trace) return;
  for (int node = 1; node <= 6; ++node)
    for (const int part : {1, 2}) {
      const std::map<std::string, int> object{
          {"node_id", node}, {"sdo.main_idx", 0x1018}, {"sdo.sub_idx", part}};
      auto asked = object, answered = object;
      asked["sdo.ccs"] = answered["sdo.scs"] = 2;  // initiate upload
      EXPECT_EQ(trace->count(asked), 1u) << node;
      EXPECT_EQ(trace->count(answered), 1u) << node;
    }
  EXPECT_EQ(trace->count({{"sdo.abort_code", -1}}), 0u);
}

TEST_F(ArmTrace, ControlwordsLeadEachDriveThrough06And07To0F) {
  decode("arm_session");
  if (!trace) return;
  for (int node = 1; node <= 6; ++node) {
    std::vector<std::string> words;
    for (const Tshark::Row& row : trace->rows()) {
      if (Tshark::number(row, "canopen.cob_id") != 0x200 + node) continue;
      const std::string word = row.at("canopen.pdo.data.bytes").substr(0, 4);
      if (words.empty() || words.back() != word) words.push_back(word);
    }
    EXPECT_THAT(words, testing::ElementsAre("0000", "0600", "0700", "0f00", "0000")) << "node " << node;
  }
}

TEST_F(ArmTrace, SyncComesEvery5Milliseconds) {
  decode("arm_session");
  if (!trace) return;
  std::vector<double> off;
  double last = 0;
  for (const Tshark::Row& row : trace->rows()) {
    if (Tshark::number(row, "canopen.cob_id") != 0x080) continue;
    if (last > 0) off.push_back(std::abs(time_of(row) - last - 0.005));
    last = time_of(row);
  }
  ASSERT_GT(off.size(), 1000u);
  std::sort(off.begin(), off.end());
  std::printf("[measured] SYNC of edgepose-servo: %zu; off by %.3f ms (median), %.3f (p99), %.3f (worst)\n",
              off.size(), off[off.size() / 2] * 1e3, off[off.size() * 99 / 100] * 1e3, off.back() * 1e3);
  EXPECT_LT(off[off.size() / 2], 0.0005);
  EXPECT_LT(off[off.size() * 9 / 10], 0.005) << "not even every tenth is left out";
}

TEST_F(ArmTrace, TheControllerHasAHeartbeatAndSoHaveTheDrives) {
  decode("arm_session");
  if (!trace) return;
  EXPECT_GT(trace->count({{"nmt_guard.state", 5}, {"node_id", 127}}), 200u) << "every 20 ms";
  for (int node = 1; node <= 6; ++node)
    EXPECT_GT(trace->count({{"nmt_guard.state", 5}, {"node_id", node}}), 100u) << "every 40 ms";
  EXPECT_EQ(trace->count({{"em.err_code", -1}}), 0u);
}

TEST_F(ArmTrace, NothingFollowsAKill) {
  decode("arm_kill");
  if (!trace) return;
  ASSERT_GT(mark, 0);
  EXPECT_GT(count(0x200, false), 0u);
  EXPECT_EQ(count(0x200, true), 0u) << "RPDOs";
  EXPECT_EQ(count(0x080, true), 0u) << "SYNC";
  EXPECT_GT(count(0x700, true), 5u) << "the drives go on with their heartbeats";
  EXPECT_GE(trace->count({{"em.err_code", -1}}), 6u) << "and each says why it has stopped";
}

TEST_F(ArmTrace, NothingFollowsBusOff) {
  decode("arm_bus_off");
  if (!trace) return;
  ASSERT_GT(mark, 0);
  EXPECT_GT(count(0x200, false), 0u);
  EXPECT_EQ(count(0x200, true), 0u) << "RPDOs";
  EXPECT_EQ(count(0x080, true), 0u) << "SYNC";
}

}  // namespace
}  // namespace edgepose
