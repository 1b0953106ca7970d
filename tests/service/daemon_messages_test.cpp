/// Interoperation with liblcm's own programs: lcm-logger hears the daemon, and the daemon hears
/// lcm-logplayer.
#include <signal.h>

#include <lcm/lcm.h>

#include "messaging/lcm_log.h"
#include "tests/service/daemon_fixture.h"

namespace edgepose {
namespace {

using test::DaemonTest;
using test::eventually;
using test::Process;

TEST_F(DaemonTest, LcmLoggerHearsItAndLcmLogplayerFeedsIt) {
  start("[frames]\nmax_age = 1000.0\n");
  register_phantom();
  const std::filesystem::path log = folder_ / "session.lcm";
  int64_t answered = 0;
  {
    Process logger(
        {"lcm-logger", "--lcm-url=udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304", "-f", log},
        folder_ / "logger");
    // lcm-logger does not say when it listens: send until it has written something.
    ASSERT_TRUE(eventually([&] {
      peer_->answer_to(peer_->send(scene()[0].depth));
      std::error_code missing;
      return std::filesystem::exists(log, missing) && std::filesystem::file_size(log, missing) > 0;
    }));
    for (int i = 0; i < 5; ++i) peer_->answer_to(peer_->send(scene()[static_cast<size_t>(i)].depth));
    answered = static_cast<int64_t>(peer_->answers().size());
    logger.signal(SIGINT);
    ASSERT_TRUE(logger.wait(10));
  }
  LcmLogReader reader(log);
  int64_t frames = 0, poses = 0, targets = 0;
  for (LoggedMessage message; reader.next(message);) {
    frames += message.channel == "EDGEPOSE_DEPTH";
    targets += message.channel == "EDGEPOSE_DRILL_TARGETS";
    if (message.channel != "EDGEPOSE_POSES") continue;
    edgepose_lcm::pose_estimates_t decoded;
    EXPECT_EQ(decode_checked(message.data, decoded), "");
    ++poses;
  }
  EXPECT_GE(frames, 5);
  EXPECT_GE(poses, 5);
  EXPECT_GE(targets, 5);
  EXPECT_LE(poses, answered);

  // Started anew, so that the old numbers are new to it; played back by liblcm's player.
  start("[frames]\nmax_age = 1000.0\n");
  const int64_t before = static_cast<int64_t>(peer_->answers().size());
  EXPECT_GT(before, 0);
  peer_->forget();
  Process player({"lcm-logplayer", "-l", "udpm://239.255.76.67:7667?ttl=0", log}, folder_ / "player");
  EXPECT_EQ(player.wait(60), 0);
  EXPECT_TRUE(eventually([&] {
    return daemon_->counter("frames_answered") + daemon_->counter("frames_superseded") == frames;
  })) << daemon_->log();
  EXPECT_GT(daemon_->counter("models_found"), 0);
}

/// What a program hears that knows liblcm only.
TEST_F(DaemonTest, LiblcmSubscribersHearStatus) {
  start();
  const std::unique_ptr<lcm_t, void (*)(lcm_t*)> listener(lcm_create(kDefaultLcmUrl), lcm_destroy);
  ASSERT_TRUE(listener);
  std::optional<edgepose_lcm::service_status_t> status;
  const auto take = [](const lcm_recv_buf_t* message, const char*, void* into) {
    edgepose_lcm::service_status_t decoded;
    if (decoded.decode(message->data, 0, static_cast<int>(message->data_size)) > 0)
      *static_cast<std::optional<edgepose_lcm::service_status_t>*>(into) = decoded;
  };
  ASSERT_TRUE(lcm_subscribe(listener.get(), "EDGEPOSE_STATUS", take, &status));
  ASSERT_TRUE(eventually([&] {
    lcm_handle_timeout(listener.get(), 100);
    return status.has_value();
  }));
  EXPECT_FALSE(status->version.empty());
  EXPECT_GT(status->uptime, 0);
}

}  // namespace
}  // namespace edgepose
