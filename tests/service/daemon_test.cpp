/// The daemon's life: start, frames, signals, kill and restart, replay bit for bit.
#include <signal.h>
#include <unistd.h>

#include <fstream>

#include "files/drill_plan.h"

#include "tests/service/daemon_fixture.h"

namespace edgepose {
namespace {

using test::DaemonTest;
using test::eventually;
using test::TrueFrame;

const Eigen::Vector3d kCentre(0.0022, 0.0254, -0.0019);  // [m] of the phantom, about

TEST_F(DaemonTest, FindsAndTracksTheMovingPhantom) {
  start();
  register_phantom();
  for (size_t i = 0; i < scene().size(); ++i) {
    const auto answer = peer_->answer_to(peer_->send(scene()[i].depth));
    const auto pose = pose_in(answer);
    ASSERT_TRUE(pose) << i << daemon_->log();
    EXPECT_LT(test::distance(*pose, scene()[i].camera_T_model, kCentre), 0.001) << i;
    EXPECT_EQ(answer->poses.answers[0].mode,
              i == 0 ? edgepose_lcm::model_answer_t::DETECTION : edgepose_lcm::model_answer_t::TRACKING);
    EXPECT_GE(answer->poses.send_utime, answer->poses.receive_utime);
  }
}

TEST_F(DaemonTest, DrillTargetsAreWhereTheyShouldBe) {
  start();
  register_phantom();
  const TrueFrame& frame = scene()[0];
  const auto targets = peer_->targets_of(peer_->send(frame.depth));
  ASSERT_TRUE(targets);
  const DrillPlan plan = read_drill_plan(test::phantom_file("drill_plan.json"));
  ASSERT_EQ(targets->targets.size(), plan.targets.size());
  for (size_t i = 0; i < plan.targets.size(); ++i) {
    const auto& target = targets->targets[i];
    const Eigen::Vector3d entry = frame.camera_T_model * plan.targets[i].entry;
    EXPECT_LT((Eigen::Map<const Eigen::Vector3d>(target.entry) - entry).norm(), 0.0015) << target.name;
    EXPECT_EQ(target.go, target.reason.empty());
    EXPECT_GT(target.tip_sigma, 0);
  }
}

/// The same session at one and two threads, as often as one likes: the same bits.
TEST_F(DaemonTest, AReplayGivesTheSameBits) {
  const auto play = [&](int threads) {
    const std::string n = std::to_string(threads);
    start("[match]\nthreads = " + n + "\n[scene]\nthreads = " + n + "\n[service]\ndeadline = 0.0\n");
    std::vector<std::vector<double>> poses;
    for (const TrueFrame& frame : scene()) {
      const auto answer = peer_->answer_to(peer_->send(frame.depth));
      EXPECT_TRUE(answer);
      if (!answer || answer->poses.answers.empty()) continue;
      for (const auto& d : answer->poses.answers[0].detections) {
        std::vector<double> all(d.camera_T_model.quaternion, d.camera_T_model.quaternion + 4);
        all.insert(all.end(), d.camera_T_model.translation, d.camera_T_model.translation + 3);
        all.insert(all.end(), &d.covariance[0][0], &d.covariance[0][0] + 36);
        all.push_back(d.score);
        poses.push_back(all);
      }
    }
    return poses;
  };
  start();
  register_phantom();
  const auto one = play(1), two = play(2);
  EXPECT_EQ(one.size(), scene().size());
  EXPECT_EQ(one, two);
}

TEST_F(DaemonTest, SigtermFinishesAndEndsWithZero) {
  start();
  register_phantom();
  const int64_t sequence = peer_->send(scene()[0].depth);
  ASSERT_TRUE(eventually([&] { return daemon_->result("stats")["stages"]["waiting"]["count"] == 1; }));
  daemon_->process().signal(SIGTERM);
  EXPECT_EQ(daemon_->process().wait(10), 0) << daemon_->log();
  EXPECT_TRUE(peer_->answer_to(sequence, 1)) << "the frame at hand is finished";
  EXPECT_FALSE(std::filesystem::exists(daemon_->socket()));
}

TEST_F(DaemonTest, SigtermEndsATrainingToo) {
  start("[train]\nsampling_step = 0.02\nviews = 1000\nmax_table_mb = 4000\n[training]\nmemory_mb = 16000\n");
  const int client = test::connect_to(daemon_->socket());
  const std::string request = nlohmann::json({{"jsonrpc", "2.0"},
                                              {"id", 1},
                                              {"method", "models.register"},
                                              {"params", {{"mesh", test::phantom_file("phantom.ply")}}}})
                                  .dump() +
                              "\n";
  ASSERT_EQ(write(client, request.data(), request.size()), static_cast<ssize_t>(request.size()));
  ASSERT_TRUE(eventually([&] { return !daemon_->result("status")["training"].empty(); }));
  daemon_->process().signal(SIGTERM);
  EXPECT_EQ(daemon_->process().wait(5), 0) << daemon_->log();
  close(client);
}

TEST_F(DaemonTest, AfterKill9ItIsBackWithinASecond) {
  start();
  register_phantom("a");
  register_phantom("b", false);
  for (int round = 0; round < 3; ++round) {
    peer_->send(scene()[0].depth);
    daemon_->process().signal(SIGKILL);
    ASSERT_EQ(daemon_->process().wait(5), -SIGKILL);
    start();
    EXPECT_LT(daemon_->ready_seconds(), 1) << "with the sockets and locks of the killed one lying about";
    const auto models = daemon_->result("models.list");
    ASSERT_EQ(models.size(), 2u);
    EXPECT_EQ(models[0]["name"], "a");
    EXPECT_EQ(models[0]["plan"], 3);
    EXPECT_TRUE(pose_in(peer_->answer_to(peer_->send(scene()[0].depth))));
  }
}

TEST_F(DaemonTest, SighupTakesWhatCanChangeLive) {
  start("[match]\naccept_score = 0.5\n");
  const auto rewrite = [&](const std::string& text) {
    std::ofstream(folder_ / "edgeposed.toml") << text;
    daemon_->process().signal(SIGHUP);
  };
  rewrite("[match]\naccept_score = 0.25\n[service]\nmax_clients = 3\n");
  ASSERT_TRUE(eventually([&] { return daemon_->result("config.get")["match.accept_score"] == 0.25; }));
  EXPECT_EQ(daemon_->result("config.get")["service.max_clients"], 16) << "needs a restart";
  EXPECT_THAT(daemon_->log(), testing::HasSubstr("event=needs_restart key=service.max_clients"));
  rewrite("[match]\nacept_score = 0.9\n");
  ASSERT_TRUE(eventually([&] { return daemon_->log().find("reload_failed") != std::string::npos; }));
  EXPECT_THAT(daemon_->log(), testing::HasSubstr("accept_score"));
  EXPECT_EQ(daemon_->result("config.get")["match.accept_score"], 0.25) << "the old options stay";
}

TEST_F(DaemonTest, TwoOnOneSocketOrFolderIsAClearError) {
  start();
  test::Folder other;
  const auto refused = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> command = {test::program("edgeposed")};
    command.insert(command.end(), arguments.begin(), arguments.end());
    test::Process second(command, other / "log");
    EXPECT_EQ(second.wait(10), 2);
    return test::read_text(other / "log");
  };
  EXPECT_THAT(refused({"--state", other / "state", "--socket", daemon_->socket()}),
              testing::HasSubstr("another program"));
  EXPECT_THAT(refused({"--state", folder_ / "state", "--socket", other / "socket"}),
              testing::HasSubstr("another program"));
  EXPECT_TRUE(daemon_->result("status")["ready"]) << "the first is not disturbed";
}

TEST_F(DaemonTest, CheckConfigSaysWhatIsWrong) {
  const auto check = [&](const std::string& text) {
    std::ofstream(folder_ / "c.toml") << text;
    std::filesystem::remove(folder_ / "check.log");
    test::Process p({test::program("edgeposed"), "--config", folder_ / "c.toml", "--check-config"},
                    folder_ / "check.log");
    const int code = p.wait(10).value_or(-99);
    return std::pair(code, test::read_text(folder_ / "check.log"));
  };
  EXPECT_EQ(check("").first, 0);
  const auto [code, text] = check("[service]\ndeadlin = 0.1\n");
  EXPECT_EQ(code, 2);
  EXPECT_THAT(text, testing::AllOf(testing::HasSubstr("c.toml:2"), testing::HasSubstr("service.deadline")));
  EXPECT_EQ(check("[service]\ndeadline = \"soon\"\n").first, 2);
  EXPECT_EQ(check("[service]\nlcm_url = \"tcpq://x\"\n").first, 2);
}

}  // namespace
}  // namespace edgepose
