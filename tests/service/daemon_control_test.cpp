/// Commands, HTTP, signatures.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <fstream>
#include <thread>

#include "messaging/signed_command.h"
#include "tests/service/daemon_fixture.h"

namespace edgepose {
namespace {

using nlohmann::json;
using test::ask;
using test::DaemonTest;
using test::eventually;
using test::phantom_file;

/// The whole answer of an HTTP server on the loopback.
std::string http(int port, const std::string& request) {
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(static_cast<uint16_t>(port));
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (connect(client, reinterpret_cast<const sockaddr*>(&to), sizeof(to)) == 0 &&
      send(client, request.data(), request.size(), MSG_NOSIGNAL) > 0) {
    std::array<char, 4096> buffer;
    for (ssize_t got; (got = recv(client, buffer.data(), buffer.size(), 0)) > 0;)
      answer.append(buffer.data(), static_cast<size_t>(got));
  }
  close(client);
  return answer;
}

std::string get(int port, const std::string& path) {
  return http(port, "GET " + path + " HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
}

TEST_F(DaemonTest, StatusStatsAndConfig) {
  start();
  register_phantom();
  ASSERT_TRUE(peer_->answer_to(peer_->send(scene()[0].depth)));
  ASSERT_TRUE(eventually([&] { return daemon_->result("status")["latency"]["count"] == 1; }));
  const json status = daemon_->result("status");
  EXPECT_TRUE(status["ready"]);
  EXPECT_EQ(status["active_models"], 1);
  EXPECT_EQ(status["last_frame"]["camera"], "test_camera") << status;
  EXPECT_GT(status["latency"]["p50"].get<double>(), 0);
  EXPECT_EQ(daemon_->result("stats")["counters"]["frames_answered"], 1);
  EXPECT_EQ(daemon_->result("config.get")["match.verification"], "free_space");
}

TEST_F(DaemonTest, DetectsInAFileAndInTheLastFrame) {
  start();
  register_phantom();
  EXPECT_EQ(daemon_->call("detect")["error"]["code"], 7) << "no frame yet";
  const json file = daemon_->result("detect", {{"depth", phantom_file("scene/depth.png")},
                                               {"intrinsics", phantom_file("scene/camera.json")}});
  EXPECT_TRUE(file["models"][0]["found"]);
  peer_->answer_to(peer_->send(scene()[0].depth));
  const json last = daemon_->result("detect", {{"models", json::array({"phantom"})}});
  EXPECT_TRUE(last["models"][0]["found"]);
  EXPECT_EQ(daemon_->call("detect", {{"depth", "/dev/null"}, {"intrinsics", "1,1,1,1"}})["error"]["code"], 1);
}

TEST_F(DaemonTest, NonsenseIsAnsweredOrCutOff) {
  start();
  for (const std::string line : {"nonsense", "[]", "{}", "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"x\"}"})
    EXPECT_TRUE(json::parse(ask(daemon_->socket(), line)).contains("error")) << line;
  EXPECT_EQ(ask(daemon_->socket(), std::string(200'000, 'x'), 5), "") << "cut off";
  EXPECT_TRUE(daemon_->result("status")["ready"]);
}

TEST_F(DaemonTest, NotificationsAreDoneAndNotAnswered) {
  start();
  register_phantom();
  const std::string deactivate =
      R"({"jsonrpc":"2.0","method":"models.activate","params":{"name":"phantom","active":false}})";
  const std::string unknown = R"({"jsonrpc":"2.0","method":"nonsense"})";
  const std::string detect = R"({"jsonrpc":"2.0","method":"detect"})";
  const std::string last = R"({"jsonrpc":"2.0","id":7,"method":"status"})";
  const json answer =
      json::parse(ask(daemon_->socket(), deactivate + "\n" + unknown + "\n" + detect + "\n" + last));
  EXPECT_EQ(answer["id"], 7) << answer;
  EXPECT_EQ(answer["result"]["active_models"], 0);
}

/// Frames go on being answered while somebody asks for one detection after the other.
TEST_F(DaemonTest, DetectCommandsDoNotHoldUpFrames) {
  start();
  register_phantom();
  peer_->answer_to(peer_->send(scene()[0].depth));
  const std::string detect = R"({"jsonrpc":"2.0","id":1,"method":"detect"})";
  std::atomic<bool> over = false;
  std::vector<std::jthread> clients;
  for (int i = 0; i < 4; ++i)
    clients.emplace_back([&] {
      while (!over) ask(daemon_->socket(), detect);
    });
  for (size_t i = 1; i < scene().size(); ++i)
    EXPECT_TRUE(pose_in(peer_->answer_to(peer_->send(scene()[i].depth)))) << i;
  // The end is not held up either.
  daemon_->process().signal(SIGTERM);
  over = true;
  EXPECT_EQ(daemon_->process().wait(5), 0);
}

TEST_F(DaemonTest, HttpTellsHealthAndMetrics) {
  start("[service]\nhttp_port = 9123\n");
  EXPECT_THAT(get(9123, "/healthz"), testing::AllOf(testing::HasSubstr("200 OK"), testing::HasSubstr("ok")));
  EXPECT_THAT(get(9123, "/metrics"), testing::HasSubstr("edgepose_models 0"));
  EXPECT_THAT(get(9123, "/secret"), testing::HasSubstr("404"));
  EXPECT_THAT(
      http(9123, "POST /metrics HTTP/1.1\r\nHost: x\r\nContent-Length: 3\r\nConnection: close\r\n\r\nabc"),
      testing::HasSubstr("405"));
  http(9123, std::string(100'000, 'x') + "\r\n\r\n");
  EXPECT_THAT(get(9123, "/healthz"), testing::HasSubstr("200 OK")) << "after nonsense";
}

TEST_F(DaemonTest, TcpControlIsOnTheLoopback) {
  start("[service]\ncontrol_port = 9124\n");
  EXPECT_EQ(http(9124, "POST / HTTP/1.1\r\n\r\n{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"shutdown\"}\n"), "")
      << "what a web page may send";
  EXPECT_TRUE(daemon_->result("status")["ready"]);
  EXPECT_THAT(http(9124, "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"shutdown\"}\n"),
              testing::HasSubstr("stopping"));
  EXPECT_EQ(daemon_->process().wait(5), 0);
}

class SignedDaemon : public DaemonTest {
 protected:
  void SetUp() override {
    DaemonTest::SetUp();
    if (IsSkipped()) return;
    key_.write(folder_ / "key");
    start("[service]\nkey_file = \"" + (folder_ / "key").string() + "\"\n");
  }
  json send(const SignedCommand& command) { return json::parse(ask(daemon_->socket(), to_line(command))); }
  SignedCommand registration(const std::string& name, int64_t utime) {
    const json request = {{"jsonrpc", "2.0"},
                          {"id", 1},
                          {"method", "models.register"},
                          {"params", {{"model", trained_phantom()}, {"name", name}}}};
    return sign(key_, request.dump(), session_, ++counter_, utime);
  }
  const SecretKey key_ = SecretKey::random();
  const int64_t session_ = test::utime_now();
  int64_t counter_ = 0;
};

TEST_F(SignedDaemon, OnlySignedFreshCommandsChangeAnything) {
  EXPECT_EQ(daemon_->call("models.register", {{"mesh", phantom_file("phantom.ply")}})["error"]["code"], 6);
  EXPECT_EQ(daemon_->call("shutdown")["error"]["code"], 6);
  EXPECT_TRUE(daemon_->result("status")["authentication"]) << "reading needs no signature";
  const SignedCommand good = registration("a", test::utime_now());
  SignedCommand altered = good;
  altered.text.replace(altered.text.find("\"a\""), 3, "\"b\"");
  EXPECT_EQ(send(altered)["error"]["code"], 6);
  EXPECT_EQ(send(registration("c", test::utime_now() - 60'000'000))["error"]["code"], 6) << "old";
  const SignedCommand fresh = registration("d", test::utime_now());
  EXPECT_TRUE(send(fresh).contains("result"));
  EXPECT_EQ(send(fresh)["error"]["code"], 6) << "replayed";
  const json counters = daemon_->result("stats")["counters"];
  EXPECT_EQ(counters["commands_refused_unsigned"], 2);
  EXPECT_EQ(counters["commands_refused_altered"], 1);
  EXPECT_EQ(counters["commands_refused_old"], 1);
  EXPECT_EQ(counters["commands_refused_replayed"], 1);
  EXPECT_EQ(daemon_->result("models.list").size(), 1u);
}

TEST_F(SignedDaemon, AnswersAreSigned) {
  ASSERT_TRUE(send(registration("a", test::utime_now())).contains("result"));
  const auto answer = peer_->answer_to(peer_->send(scene()[0].depth));
  ASSERT_TRUE(answer);
  MessageVerifier verifier(key_);
  EXPECT_EQ(verifier.judge("EDGEPOSE_POSES", answer->bytes), Authenticity::kGenuine);
  EXPECT_EQ(verifier.judge("EDGEPOSE_POSES", answer->bytes), Authenticity::kReplayed);
  auto changed = answer->bytes;
  changed[100] ^= std::byte{1};
  EXPECT_EQ(MessageVerifier(key_).judge("EDGEPOSE_POSES", changed), Authenticity::kAltered);
  EXPECT_EQ(MessageVerifier(SecretKey::random()).judge("EDGEPOSE_POSES", answer->bytes),
            Authenticity::kAltered);
}

TEST_F(DaemonTest, AKeyThatOthersCanReadIsRefused) {
  SecretKey::random().write(folder_ / "key");
  std::filesystem::permissions(folder_ / "key", std::filesystem::perms(0644));
  daemon_ = std::make_unique<test::Daemon>(folder_ / "",
                                           "[service]\nkey_file = \"" + (folder_ / "key").string() + "\"\n");
  EXPECT_FALSE(daemon_->ready());
  EXPECT_EQ(daemon_->process().wait(5), 2);
  EXPECT_THAT(daemon_->log(), testing::HasSubstr("chmod 600"));
}

}  // namespace
}  // namespace edgepose
