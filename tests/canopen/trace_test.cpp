// A session, recorded as a capture, in the words of an independent decoder: tshark's CANopen dissector.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>

#include "bus/pcap_writer.h"
#include "tests/canopen/arm_on_wire.h"
#include "tests/canopen/tshark.h"

namespace edgepose {
namespace {

constexpr int64_t kWallMinusSteady = 1'700'000'000'000'000'000;

/// A session with an EMCY at its end, as a capture.
class Trace : public testing::Test {
 protected:
  using Row = Tshark::Row;
  static void SetUpTestSuite() {
    if (!Tshark::is_there()) return;
    file_ = testing::TempDir() + "canopen_session_" + std::to_string(getpid()) + ".pcap";
    arm_ = new ArmOnWire;
    arm_->enable_and_move();
    arm_->drives[2]->provoke(Provocation::kEmergency);
    arm_->move(0.5, 30);
    PcapWriter writer(file_, kWallMinusSteady);
    for (const CanFrame& frame : arm_->wire.trace) writer.write(frame);
    writer.flush();
    tshark_ = new Tshark(file_);
    words_ = tshark_->words("canopen.nmt_ctrl.cd || canopen.em.err_code");
  }
  static void TearDownTestSuite() {
    if (arm_) std::remove(file_.c_str());
    delete arm_;
    delete tshark_;
    tshark_ = nullptr;
    arm_ = nullptr;
  }
  void SetUp() override {
    if (!arm_)
      GTEST_SKIP() << "NOT TESTED: there is no tshark to decode the bus trace; apt-get install tshark";
  }
  static int number(const Row& row, const std::string& field) { return Tshark::number(row, field); }
  static size_t count(const std::map<std::string, int>& said) { return tshark_->count(said); }
  static size_t on_wire(uint16_t id) { return arm_->count(id); }

  static inline Tshark* tshark_ = nullptr;  ///< decoded once
  static inline std::string words_;
  static inline std::string file_;
  static inline ArmOnWire* arm_ = nullptr;
};

TEST_F(Trace, EveryFrameIsThereAndNoneIsMalformed) {
  EXPECT_EQ(tshark_->rows().size(), arm_->wire.trace.size());
  EXPECT_EQ(count({{"cob_id", -1}}), arm_->wire.trace.size());
  for (const Row& row : tshark_->rows()) EXPECT_FALSE(row.contains("_ws.malformed"));
}

TEST_F(Trace, NmtResetsAndStartsEachNode) {
  for (int node = 1; node <= 6; ++node) {
    EXPECT_EQ(count({{"nmt_ctrl.cd", 0x82}, {"nmt_ctrl.node_id", node}}), 1u);
    EXPECT_EQ(count({{"nmt_ctrl.cd", 0x01}, {"nmt_ctrl.node_id", node}}), 1u);
  }
  EXPECT_THAT(words_, testing::HasSubstr("Reset communication"));
  EXPECT_THAT(words_, testing::HasSubstr("Start remote node"));
}

TEST_F(Trace, HeartbeatsSayBootUpThenPreOperationalThenOperational) {
  std::vector<int> states;
  for (const Row& row : tshark_->rows()) {
    if (number(row, "canopen.node_id") != 3 || !row.contains("canopen.nmt_guard.state")) continue;
    const int state = number(row, "canopen.nmt_guard.state");
    if (states.empty() || states.back() != state) states.push_back(state);
  }
  EXPECT_THAT(states, testing::ElementsAre(0, 127, 5));
  EXPECT_EQ(count({{"nmt_guard.state", 5}, {"node_id", 127}}), on_wire(0x77f)) << "the master's own";
}

TEST_F(Trace, SdoReadsTheIdentityAndAbortsNothing) {
  EXPECT_EQ(count({{"sdo.main_idx", 0x1018}, {"sdo.sub_idx", 1}, {"sdo.ccs", 2}}), 6u);
  EXPECT_EQ(count({{"sdo.main_idx", 0x1018}, {"sdo.sub_idx", 1}, {"sdo.scs", 2}}), 6u);
  EXPECT_EQ(count({{"sdo.main_idx", 0x6007}, {"sdo.ccs", 1}}), 6u);
  EXPECT_EQ(count({{"sdo.abort_code", -1}}), 0u);
  for (const Row& row : tshark_->rows())
    if (number(row, "canopen.sdo.main_idx") == 0x1018 && number(row, "canopen.sdo.sub_idx") == 1 &&
        number(row, "canopen.sdo.scs") == 2) {
      EXPECT_THAT(row.at("canopen.sdo.data.bytes"), testing::StartsWith("d90e0000")) << "the vendor";
    }
}

TEST_F(Trace, PdosAndSyncOfEveryCycle) {
  EXPECT_EQ(count({{"cob_id", 0x080}}), on_wire(0x080));
  EXPECT_GT(on_wire(0x080), 60u);
  size_t stops = 0;
  for (const Row& row : tshark_->rows())
    if (number(row, "canopen.cob_id") == 0x204) stops += row.at("canopen.pdo.data.bytes").starts_with("0200");
  EXPECT_GT(stops, 20u) << "quick stop";
  for (const int id : {0x201, 0x186, 0x283}) {
    size_t with_data = 0;
    for (const Row& row : tshark_->rows())
      with_data += number(row, "canopen.cob_id") == id && row.contains("canopen.pdo.data.bytes");
    EXPECT_EQ(with_data, on_wire(static_cast<uint16_t>(id)));
  }
}

TEST_F(Trace, TheEmergencyIsNamed) {
  EXPECT_EQ(count({{"em.err_code", 0x4210}, {"node_id", 3}}), 1u);
  EXPECT_EQ(count({{"em.err_code", -1}}), 1u);
  EXPECT_THAT(words_, testing::HasSubstr("Temperature"));
}

}  // namespace
}  // namespace edgepose
