#include <gtest/gtest.h>
#include <sys/socket.h>

#include <csignal>
#include <nlohmann/json.hpp>

#include "bus/open_bus.h"
#include "bus/steady_clock.h"
#include "bus/unix_address.h"
#include "canopen/master.h"
#include "canopen/nmt.h"
#include "canopen/sdo_client.h"
#include "common/error.h"
#include "daemon/real_time.h"
#include "edgepose_lcm/arm_truth_t.hpp"
#include "messaging/checked_decode.h"
#include "messaging/depth_message.h"
#include "tests/client/bus.h"
#include "tests/client/child.h"

namespace edgepose {
namespace {

using nlohmann::json;
using test::Child;

constexpr int64_t kMillisecond = 1'000'000;
constexpr double kCycle = 0.020;  // [s]

std::string phantom(const std::string& name) {
  return std::string(EDGEPOSE_SOURCE_DIR) + "/models/phantom/" + name;
}

std::vector<std::string> sim(const std::vector<std::string>& arguments) {
  std::vector<std::string> all = {std::string(EDGEPOSE_PROGRAM_DIR) + "/edgepose-sim", "--model",
                                  phantom("phantom.ply"), "--plan", phantom("drill_plan.json")};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return all;
}

class SimProcess : public testing::Test {
 protected:
  void SetUp() override {
    if (!enter_own_network()) GTEST_SKIP() << "no network of its own on this machine";
  }
  /// Starts it and waits until everything listens.
  Child& start(std::vector<std::string> more) {
    for (const std::string& word : {std::string("--bus"), "unix:" + bus_path, std::string("--control"),
                                    control_path, std::string("--ready")})
      more.push_back(word);
    child = std::make_unique<Child>(sim(more));
    EXPECT_TRUE(test::eventually([&] { return child->out().starts_with("READY "); })) << child->err();
    return *child;
  }
  json command(const std::string& method, const json& params = json::object()) {
    const int client = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const UnixAddress address = unix_address(control_path);
    EXPECT_EQ(connect(client, address.get(), sizeof(address.value)), 0);
    const std::string line =
        json{{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", params}}.dump() + "\n";
    EXPECT_EQ(send(client, line.data(), line.size(), 0), std::ssize(line));
    std::string answer;
    for (char c = 0; recv(client, &c, 1, 0) == 1 && c != '\n';) answer += c;
    close(client);
    return json::parse(answer);
  }
  /// The master's cycles, until `holds`; false after 20 s.
  bool run(Master& master, PerAxis<double>& points, double velocity, const std::function<bool()>& holds) {
    become_real_time(50);  // where it may; else the test needs a machine of its own
    int64_t next = steady_ns();
    for (const int64_t end = next + 20'000 * kMillisecond; next < end && !holds();) {
      for (double& point : points) point += velocity * kCycle;
      master.cycle(steady_ns(), points);
      next += static_cast<int64_t>(kCycle * 1e9);
      wait_for_input(-1, next);
    }
    return holds();
  }

  test::Folder folder;
  const std::string bus_path = folder / "bus.sock", control_path = folder / "control.sock";
  std::unique_ptr<Child> child;
};

TEST_F(SimProcess, AnswersNmtAndSdoAndEndsCleanly) {
  start({"--publish", "none"});
  const auto bus = open_bus("unix:" + bus_path);
  SdoClient client(*bus, 3);
  client.upload(object::kVendor, steady_ns(), 2'000 * kMillisecond);
  bool boot_up = false, reset = false;
  for (const int64_t end = steady_ns() + 5'000 * kMillisecond; steady_ns() < end && !boot_up;) {
    const Received received = bus->receive(steady_ns() + kMillisecond);
    if (received.kind == Received::Kind::kFrame && received.frame.id == 0x583)
      client.take(received.frame, steady_ns());
    client.tick(steady_ns());
    if (client.state() != SdoClient::State::kBusy && !reset) {
      reset = true;
      bus->send(nmt_frame({NmtCommand::kResetNode, 3}, steady_ns()));
    }
    boot_up = reset && received.kind == Received::Kind::kFrame && received.frame.id == 0x703 &&
              decode_heartbeat(received.frame) == NmtState::kBootUp;
  }
  ASSERT_EQ(client.state(), SdoClient::State::kDone);
  ASSERT_EQ(client.data().size(), 4u);
  EXPECT_EQ(client.data()[0], 0xd9);
  EXPECT_TRUE(boot_up);
  child->signal(SIGTERM);
  EXPECT_EQ(child->wait().code, 0);
  EXPECT_FALSE(std::filesystem::exists(bus_path));
}

TEST_F(SimProcess, AMasterMovesItsDrivesAndCommandsProvokeThem) {
  start({"--publish", "none", "--start-at", "standoff", "--truth", folder / "truth.csv"});
  const auto bus = open_bus("unix:" + bus_path, MasterOptions{}.received_ids());
  MasterOptions options;
  // A slow cycle and patient watchdogs: the test may be late where others work on the machine.
  options.cycle = kCycle;
  options.rpdo_timeout = 0.5, options.max_missed = 20;
  options.master_heartbeat_timeout = options.drive_heartbeat_timeout = 1;
  Master master(*bus, options);
  PerAxis<double> points{};
  const auto in = [&](MasterPhase phase) { return [&, phase] { return master.state().phase == phase; }; };
  ASSERT_TRUE(master.set_up(steady_ns()));
  ASSERT_TRUE(run(master, points, 0, in(MasterPhase::kReady))) << master.fault_text();
  ASSERT_TRUE(run(master, points, 0, [&] { return master.state().all_fresh; })) << master.fault_text();
  ASSERT_EQ(master.enable(steady_ns()), EnableResult::kBegun);
  ASSERT_TRUE(run(master, points, 0, in(MasterPhase::kEnabled))) << master.fault_text();
  for (size_t i = 0; i < kAxes; ++i) points[i] = master.state().axes[i].position;
  const double from = points[5];
  run(master, points, 0.1, [&] { return points[5] > from + 0.05; });
  EXPECT_GT(command("status")["result"]["drives"][5]["position_rad"].get<double>(), from + 0.02)
      << master.fault_text();
  EXPECT_TRUE(command("provoke", {{"node", 2}, {"kind", "emergency"}}).contains("result"));
  EXPECT_TRUE(run(master, points, 0.1, in(MasterPhase::kFault)));
  EXPECT_NE(master.fault_text().find("node 2"), std::string::npos) << master.fault_text();
  command("shutdown");
  EXPECT_EQ(child->wait().code, 0);
  EXPECT_GT(test::read_file(folder / "truth.csv").size(), 10000u);
}

TEST_F(SimProcess, PublishesDepthFramesAndTheTruth) {
  test::Bus lcm;
  start({"--told", folder / "told", "--seed", "5", "--camera-name", "wrist"});
  ASSERT_TRUE(lcm.wait_for("EDGEPOSE_DEPTH", 2));
  ASSERT_TRUE(lcm.wait_for("EDGEPOSE_TRUTH", 2));
  edgepose_lcm::depth_frame_t message{};
  ASSERT_EQ(decode_checked(lcm.on("EDGEPOSE_DEPTH").front(), message), "");
  DepthFrame frame;
  std::string detail;
  ASSERT_EQ(unpack(message, frame, detail), FrameFault::kNone) << detail;
  EXPECT_EQ(frame.camera, "wrist");
  EXPECT_EQ(frame.image.width, 640);
  const json told = json::parse(test::read_file(folder / "told/camera.json"));
  EXPECT_EQ(frame.intrinsics.fx, told["fx"].get<double>());
  const auto truth = lcm.on("EDGEPOSE_TRUTH").front();
  edgepose_lcm::arm_truth_t arm{};
  ASSERT_EQ(arm.decode(truth.data(), 0, static_cast<int>(truth.size())), std::ssize(truth));
  EXPECT_EQ(arm.target, "left_pedicle_screw");
}

TEST_F(SimProcess, PublishesSignedPosesAndWrongOnesOnCommand) {
  SecretKey::random().write(folder / "key");
  MessageVerifier verifier(SecretKey::read(folder / "key"));
  test::Bus lcm;
  start({"--publish", "poses", "--key", folder / "key"});
  ASSERT_TRUE(lcm.wait_for("EDGEPOSE_POSES", 3));
  EXPECT_EQ(verifier.judge("EDGEPOSE_POSES", lcm.on("EDGEPOSE_POSES").front()), Authenticity::kGenuine);
  command("poses", {{"wrong", "unsigned"}});
  const size_t before = lcm.count("EDGEPOSE_POSES");
  ASSERT_TRUE(lcm.wait_for("EDGEPOSE_POSES", before + 2));
  EXPECT_EQ(verifier.judge("EDGEPOSE_POSES", lcm.on("EDGEPOSE_POSES").back()), Authenticity::kUnsigned);
}

TEST_F(SimProcess, BusOffFloodAndEndOfTheBusReachItsMembers) {
  start({"--publish", "none"});
  const auto bus = open_bus("unix:" + bus_path);
  const auto hears = [&](const std::function<bool(const Received&)>& what) {
    for (const int64_t end = steady_ns() + 5'000 * kMillisecond; steady_ns() < end;)
      if (what(bus->receive(steady_ns() + kMillisecond))) return true;
    return false;
  };
  EXPECT_TRUE(command("bus", {{"off", true}}).contains("result"));
  EXPECT_TRUE(hears([](const Received& r) { return r.event == BusEvent::kBusOff; }));
  EXPECT_TRUE(command("flood", {{"seconds", 0.2}}).contains("result"));
  int frames = 0;
  EXPECT_TRUE(hears([&](const Received& r) {
    return r.kind == Received::Kind::kFrame && r.frame.id == 1 && ++frames > 500;
  }));
  EXPECT_TRUE(command("bus", {{"down", true}}).contains("result"));
  EXPECT_TRUE(hears([](const Received& r) { return r.event == BusEvent::kDown; }));
  EXPECT_FALSE(command("status")["result"]["bus_up"].get<bool>());
}

TEST_F(SimProcess, RefusesCommandsInOneLine) {
  start({"--publish", "none"});
  const auto refused = [&](const std::string& method, const json& params, const std::string& word) {
    const json answer = command(method, params);
    ASSERT_TRUE(answer.contains("error")) << method;
    EXPECT_NE(answer["error"]["message"].get<std::string>().find(word), std::string::npos) << answer;
  };
  refused("provoke", {{"node", 7}, {"kind", "jam"}}, "params.node");
  refused("provoke", {{"node", 1}, {"kind", "hot"}}, "params.kind");
  refused("provoke", {{"node", 1.5}, {"kind", "jam"}}, "params.node");
  refused("poses", {{"wrong", "old"}}, "--publish poses");
  refused("drop_sync", {{"count", 1}, {"counts", 2}}, "counts");
  refused("flood", {{"seconds", 1e9}}, "params.seconds");
  refused("jump", json::object(), "expected one of");
}

TEST_F(SimProcess, BadInputIsOneLineAndExitCode2) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& word) {
    const test::Finished run = Child(std::move(arguments)).wait();
    EXPECT_EQ(run.code, 2) << word;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_NE(run.err.find(word), std::string::npos) << run.err;
  };
  const std::string bus = "unix:" + bus_path;
  refused(sim({"--target", "elbow", "--bus", bus}), "elbow");
  refused(sim({"--bus", "can_of_none"}), "can_of_none");
  refused(sim({"--bus", "pcap:/tmp/x"}), "pcap");
  refused(sim({"--bus", bus, "--sensor", "eye"}), "sensor");
  refused(sim({"--bus", bus, "--publish", "all"}), "--publish");
  refused(sim({"--bus", bus, "--absent-node", "9"}), "absent-node");
  refused({std::string(EDGEPOSE_PROGRAM_DIR) + "/edgepose-sim"}, "--model");
}

}  // namespace
}  // namespace edgepose
