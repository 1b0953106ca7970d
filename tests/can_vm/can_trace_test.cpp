// On the host, after socket_can_test in the guest: the session that it recorded on vcan0, as tshark
// understands it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/canopen/tshark.h"

namespace edgepose {
namespace {

class CanTrace : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const char* folder = std::getenv("EDGEPOSE_CAN_TRACES");
    if (folder && Tshark::is_there() && std::filesystem::exists(std::string(folder) + "/session.pcap"))
      session_ = new Tshark(std::string(folder) + "/session.pcap");
  }
  static void TearDownTestSuite() { delete session_; }
  void SetUp() override {
    if (!session_)
      GTEST_SKIP()
          << "NOT TESTED: no session from a vcan0, or no tshark; tests/can_vm/can_vm_test.sh makes one";
  }
  static size_t count(const std::map<std::string, int>& said) { return session_->count(said); }
  /// [s] when each frame of this identifier was on the bus.
  static std::vector<double> times_of(int id) {
    std::vector<double> times;
    for (const Tshark::Row& row : session_->rows())
      if (Tshark::number(row, "canopen.cob_id") == id)
        times.push_back(std::strtod(row.at("frame.time_epoch").c_str(), nullptr));
    return times;
  }

  static inline Tshark* session_ = nullptr;
};

TEST_F(CanTrace, AllIsCanopenAndNothingMalformed) {
  EXPECT_GT(session_->rows().size(), 5000u);
  EXPECT_EQ(count({{"cob_id", -1}}), session_->rows().size());
  for (const Tshark::Row& row : session_->rows()) EXPECT_FALSE(row.contains("_ws.malformed"));
}

TEST_F(CanTrace, EachNodeIsResetAndStarted) {
  for (int node = 1; node <= 6; ++node) {
    EXPECT_EQ(count({{"nmt_ctrl.cd", 0x82}, {"nmt_ctrl.node_id", node}}), 1u);
    EXPECT_EQ(count({{"nmt_ctrl.cd", 0x01}, {"nmt_ctrl.node_id", node}}), 1u);
  }
}

TEST_F(CanTrace, SyncComesEvery5Milliseconds) {
  const std::vector<double> times = times_of(0x080);
  ASSERT_GT(times.size(), 450u);
  const double mean = (times.back() - times.front()) / static_cast<double>(times.size() - 1);
  EXPECT_NEAR(mean, 0.005, 0.01 * 0.005);
  std::vector<double> off;
  for (size_t i = 1; i < times.size(); ++i) off.push_back(std::abs(times[i] - times[i - 1] - 0.005));
  std::sort(off.begin(), off.end());
  std::printf(
      "[measured] SYNC: %zu, mean period %.4f ms; off by %.3f ms (median), %.3f (p99), %.3f (worst)\n",
      times.size(), mean * 1e3, off[off.size() / 2] * 1e3, off[off.size() * 99 / 100] * 1e3,
      off.back() * 1e3);
}

TEST_F(CanTrace, EveryNodeHasItsPdosInEveryCycle) {
  const size_t syncs = times_of(0x080).size();
  for (int node = 1; node <= 6; ++node) {
    // The trace may end within a cycle.
    EXPECT_NEAR(static_cast<double>(times_of(0x200 + node).size()), static_cast<double>(syncs), 1) << node;
    EXPECT_NEAR(static_cast<double>(times_of(0x180 + node).size()), static_cast<double>(syncs), 3) << node;
    EXPECT_NEAR(static_cast<double>(times_of(0x280 + node).size()), static_cast<double>(syncs) / 4, 3)
        << node;
    size_t enabled = 0;
    for (const Tshark::Row& row : session_->rows())
      enabled += Tshark::number(row, "canopen.cob_id") == 0x200 + node &&
                 row.at("canopen.pdo.data.bytes").starts_with("0f00");
    EXPECT_GT(enabled, 400u) << "2 s in operation";
  }
}

TEST_F(CanTrace, SdoConfiguresEachNodeAndAbortsNothing) {
  for (const int index : {0x1017, 0x1016, 0x6007, 0x1400, 0x1A00, 0x60C2})
    EXPECT_GE(count({{"sdo.main_idx", index}, {"sdo.ccs", 1}}), 6u) << std::hex << index;
  EXPECT_EQ(count({{"sdo.main_idx", 0x1018}, {"sdo.sub_idx", 1}, {"sdo.scs", 2}}), 6u);
  EXPECT_EQ(count({{"sdo.abort_code", -1}}), 0u);
}

TEST_F(CanTrace, HeartbeatsOfTheDrivesAndOfTheMaster) {
  for (int node = 1; node <= 6; ++node) {
    EXPECT_GT(count({{"nmt_guard.state", 5}, {"node_id", node}}), 50u) << "2.5 s, every 40 ms";
    EXPECT_GE(count({{"nmt_guard.state", 0}, {"node_id", node}}), 1u) << "boot-up";
  }
  EXPECT_GT(count({{"nmt_guard.state", 5}, {"node_id", 127}}), 100u) << "every 20 ms";
}

TEST_F(CanTrace, TheEmergencyIsNamed) {
  EXPECT_EQ(count({{"em.err_code", 0x4210}, {"node_id", 3}}), 1u);
  EXPECT_EQ(count({{"em.err_code", -1}}), 1u);
  EXPECT_THAT(session_->words("canopen.em.err_code"), testing::HasSubstr("Temperature"));
}

}  // namespace
}  // namespace edgepose
