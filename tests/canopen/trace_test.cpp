// A session, recorded as a capture, in the words of an independent decoder: tshark's CANopen dissector.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <map>
#include <sstream>

#include "bus/pcap_writer.h"
#include "tests/canopen/arm_on_wire.h"

namespace edgepose {
namespace {

constexpr int64_t kWallMinusSteady = 1'700'000'000'000'000'000;

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return text;
  std::array<char, 4096> block;
  for (size_t got; (got = fread(block.data(), 1, block.size(), pipe)) > 0;) text.append(block.data(), got);
  pclose(pipe);
  return text;
}

/// A session with an EMCY at its end, as a capture.
class Trace : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (output_of("command -v tshark").empty()) return;
    file_ = testing::TempDir() + "canopen_session_" + std::to_string(getpid()) + ".pcap";
    arm_ = new ArmOnWire;
    arm_->enable_and_move();
    arm_->drives[2]->provoke(Provocation::kEmergency);
    arm_->move(0.5, 30);
    PcapWriter writer(file_, kWallMinusSteady);
    for (const CanFrame& frame : arm_->wire.trace) writer.write(frame);
  }
  static void TearDownTestSuite() {
    if (arm_) std::remove(file_.c_str());
    delete arm_;
    arm_ = nullptr;
  }
  void SetUp() override {
    if (!arm_)
      GTEST_SKIP() << "NOT TESTED: there is no tshark to decode the bus trace; apt-get install tshark";
  }
  static std::string tshark(const std::string& what) {
    return output_of("tshark -r '" + file_ + "' -d can.subdissector,canopen " + what + " 2>/dev/null");
  }
  /// Lines of what tshark says of the frames that `filter` lets through.
  static size_t count(const std::string& filter) {
    const std::string lines = tshark("-Y '" + filter + "' -T fields -e frame.number");
    return static_cast<size_t>(std::count(lines.begin(), lines.end(), '\n'));
  }
  static size_t on_wire(uint16_t id) { return arm_->count(id); }

  static inline std::string file_;
  static inline ArmOnWire* arm_ = nullptr;
};

TEST_F(Trace, EveryFrameIsThereAndNoneIsMalformed) {
  EXPECT_EQ(count("canopen"), arm_->wire.trace.size());
  EXPECT_EQ(count("_ws.malformed"), 0u);
  EXPECT_EQ(count("can.len > 8"), 0u);
}

TEST_F(Trace, NmtResetsAndStartsEachNode) {
  for (int node = 1; node <= 6; ++node) {
    const std::string of = "canopen.nmt_ctrl.node_id == " + std::to_string(node);
    EXPECT_EQ(count("canopen.nmt_ctrl.cd == 0x82 && " + of), 1u);
    EXPECT_EQ(count("canopen.nmt_ctrl.cd == 0x01 && " + of), 1u);
  }
  const std::string verbose = tshark("-V -Y 'canopen.nmt_ctrl.cd'");
  EXPECT_THAT(verbose, testing::HasSubstr("Reset communication"));
  EXPECT_THAT(verbose, testing::HasSubstr("Start remote node"));
}

TEST_F(Trace, HeartbeatsSayBootUpThenPreOperationalThenOperational) {
  const std::string lines =
      tshark("-Y 'canopen.nmt_guard.state && canopen.node_id == 3' -T fields -e canopen.nmt_guard.state");
  std::istringstream read(lines);
  std::vector<int> states;
  for (std::string line; std::getline(read, line);) {
    const int state = static_cast<int>(std::strtol(line.c_str(), nullptr, 0)) & 0x7f;
    if (states.empty() || states.back() != state) states.push_back(state);
  }
  // Booted once when it was powered and once when the master reset it.
  EXPECT_THAT(states,
              testing::AnyOf(testing::ElementsAre(0, 127, 5), testing::ElementsAre(0, 127, 0, 127, 5)));
  EXPECT_EQ(count("canopen.nmt_guard.state && canopen.node_id == 127"), on_wire(0x77f)) << "the master's own";
}

TEST_F(Trace, SdoReadsTheIdentityAndAbortsNothing) {
  EXPECT_EQ(count("canopen.sdo.main_idx == 0x1018 && canopen.sdo.sub_idx == 1 && canopen.sdo.ccs == 2"), 6u);
  EXPECT_EQ(count("canopen.sdo.main_idx == 0x1018 && canopen.sdo.sub_idx == 1 && canopen.sdo.scs == 2"), 6u);
  EXPECT_EQ(count("canopen.sdo.abort_code"), 0u);
  const std::string vendor = tshark(
      "-V -Y 'canopen.sdo.main_idx == 0x1018 && canopen.sdo.sub_idx == 1 && canopen.sdo.scs == 2 && "
      "canopen.node_id == 1'");
  EXPECT_THAT(vendor, testing::HasSubstr("d90e0000"));
  EXPECT_EQ(count("canopen.sdo.main_idx == 0x6007 && canopen.sdo.ccs == 1"), 6u);
}

TEST_F(Trace, PdosAndSyncOfEveryCycle) {
  EXPECT_EQ(count("canopen.cob_id == 0x080"), on_wire(0x080));
  EXPECT_GT(on_wire(0x080), 60u);
  for (const uint16_t id : std::array<uint16_t, 3>{0x201, 0x186, 0x283}) {
    char filter[64];
    std::snprintf(filter, sizeof(filter), "canopen.cob_id == 0x%x && canopen.pdo.data.bytes", unsigned{id});
    EXPECT_EQ(count(filter), on_wire(id));
  }
  EXPECT_GT(count("canopen.cob_id == 0x204 && canopen.pdo.data.bytes[0:2] == 02:00"), 20u) << "quick stop";
}

TEST_F(Trace, TheEmergencyIsNamed) {
  EXPECT_EQ(count("canopen.em.err_code == 0x4210 && canopen.node_id == 3"), 1u);
  EXPECT_EQ(count("canopen.em.err_code && canopen.em.err_code != 0x4210"), 0u);
  const std::string verbose = tshark("-V -Y 'canopen.em.err_code'");
  EXPECT_THAT(verbose, testing::HasSubstr("Temperature"));
}

}  // namespace
}  // namespace edgepose
