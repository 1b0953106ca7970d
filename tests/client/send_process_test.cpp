/// `edgepose send` over real LCM.
#include <gmock/gmock.h>

#include <csignal>

#include "client/service/depth_files.h"
#include "messaging/depth_message.h"
#include "messaging/lcm_log.h"
#include "tests/client/child.h"
#include "tests/client/fake_service.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

const std::string kScene = std::string(EDGEPOSE_SOURCE_DIR) + "/models/sample_set/test/000001";

class SendProcess : public OnOwnNetwork {};

std::vector<DepthFrame> frames_in(const std::string& path) {
  LcmLogReader reader(path);
  std::vector<DepthFrame> frames;
  for (LoggedMessage message; reader.next(message);) {
    if (message.channel != channels::kDepth) continue;
    edgepose_lcm::depth_frame_t decoded;
    EXPECT_EQ(decode_checked(std::span<const std::byte>(message.data), decoded), "");
    std::string detail;
    frames.emplace_back();
    EXPECT_EQ(unpack(decoded, frames.back(), detail), FrameFault::kNone) << detail;
  }
  return frames;
}

/// lcm-logger hands its last messages to the system only when one more has come: says something.
bool has_logged(Bus& bus, const std::string& path, size_t frames) {
  return eventually([&] {
    bus.publish("NUDGE", std::vector<std::byte>(1));
    return std::filesystem::exists(path) && std::filesystem::file_size(path) > 0 &&
           frames_in(path).size() == frames;
  });
}

TEST_F(SendProcess, LcmLoggerRecordsEveryFrameAsItIsOnDisk) {
  Bus bus;
  const Folder folder;
  const std::string log = folder / "log";
  Child logger({"lcm-logger", std::string("--lcm-url=") + kDefaultLcmUrl, log});
  ASSERT_TRUE(bus.wait_for("LCM_SELF_TEST", 1)) << "it has joined the group: " << logger.err();
  const int64_t before = utime_now();
  const Finished send = Child(program({"send", kScene, "--rate", "60", "--camera", "left"})).wait();
  ASSERT_EQ(send.code, 0) << send.err;
  EXPECT_THAT(send.out, HasSubstr("sent 6 frames of 'left'"));
  ASSERT_TRUE(has_logged(bus, log, 6));
  const auto files = find_depth_files({kScene}, {});
  const auto frames = frames_in(log);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(frames[i].camera, "left");
    EXPECT_EQ(frames[i].sequence, frames[0].sequence + static_cast<int64_t>(i));
    EXPECT_GE(frames[i].capture_utime, before);
    EXPECT_LE(frames[i].capture_utime, utime_now());
    EXPECT_EQ(frames[i].intrinsics.fx, files[i].camera.fx);
    EXPECT_EQ(frames[i].image.depth, read_depth_file(files[i]).depth);
  }
  // A later run goes on beyond.
  ASSERT_EQ(
      Child(program({"send", kScene, "--rate", "60", "--camera", "left", "--encoding", "raw"})).wait().code,
      0);
  ASSERT_TRUE(has_logged(bus, log, 12));
  EXPECT_GT(frames_in(log)[6].sequence, frames[5].sequence);
  EXPECT_EQ(frames_in(log)[6].image.depth, frames[0].image.depth) << "raw or compressed, the same";
}

TEST_F(SendProcess, WaitingItLosesNothing) {
  FakeService service;
  const Finished run = Child(program({"send", kScene, "--wait", "--rate", "0", "--repeat", "5"})).wait();
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("sent 30 frames"));
  EXPECT_THAT(run.out, HasSubstr("answered 30, latency"));
  EXPECT_EQ(service.bus().count(channels::kDepth), 30u);
}

TEST_F(SendProcess, WithoutAServiceItSaysThatAnswersAreMissing) {
  FakeService service;
  service.silent = true;
  const Finished run = Child(program({"send", kScene, "--wait", "--timeout", "0.05"})).wait();
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, HasSubstr("answered 0"));
}

TEST_F(SendProcess, ForEverUntilCtrlC) {
  Bus bus;
  Child send(program({"send", kScene, "--rate", "100", "--repeat", "0"}));
  ASSERT_TRUE(bus.wait_for(channels::kDepth, 20)) << send.err();
  send.signal(SIGINT);
  const Finished run = send.wait();
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, HasSubstr("sent "));
}

TEST_F(SendProcess, BadInputIsOneLine) {
  expect_refused(Child(program({"send", "/nonexistent.png", "--intrinsics", "4,4,2,1"})).wait(),
                 {"/nonexistent.png"});
  expect_refused(Child(program({"send", kScene, "--rate", "0"})).wait(), {"--wait"});
  expect_refused(Child(program({"send", kScene, "--camera", "two words"})).wait(), {"printable"});
  expect_refused(Child(program({"send", kScene, "--url", "udpm://1.2.3.4:5"})).wait(), {"multicast"});
  expect_refused(Child(program({"send", kScene, "--rate", "nan"})).wait(), {"rate"});
}

}  // namespace
}  // namespace edgepose::test
