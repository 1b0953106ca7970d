#include "daemon/line_server.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "common/error.h"
#include "tests/service/daemon.h"

namespace edgepose {
namespace {

using test::ask;
using test::connect_to;
using test::eventually;

class Server : public testing::Test {
 protected:
  void start(const LineServerOptions& options = {}) {
    std::vector<ListeningSocket> sockets;
    sockets.push_back(ListeningSocket::on_file(path_));
    server_ = std::make_unique<LineServer>(
        std::move(sockets),
        [this](LineServer::ClientId client, const std::string& line) -> std::optional<std::string> {
          if (line != "later") return "echo " + line;
          waiting_ = client;
          return std::nullopt;
        },
        counters_, options);
    server_->start();
  }
  std::string read_line(int client) const {
    std::string text;
    for (char c = 0; recv(client, &c, 1, 0) == 1 && c != '\n';) text += c;
    return text;
  }
  void write(int client, const std::string& text) const {
    ::send(client, text.data(), text.size(), MSG_NOSIGNAL);
  }

  test::Folder folder_;
  std::filesystem::path path_ = folder_ / "socket";
  Counters counters_;
  std::atomic<LineServer::ClientId> waiting_ = 0;
  std::unique_ptr<LineServer> server_;
};

TEST_F(Server, AnswersLineByLine) {
  start();
  EXPECT_EQ(ask(path_, "hello"), "echo hello");
  const int client = connect_to(path_);
  write(client, "a\nb\r\n\nc");
  EXPECT_EQ(read_line(client), "echo a");
  EXPECT_EQ(read_line(client), "echo b");
  write(client, "d\n");
  EXPECT_EQ(read_line(client), "echo cd");
  close(client);
}

TEST_F(Server, TheSocketIsForItsGroupOnly) {
  start();
  struct stat state {};
  ASSERT_EQ(stat(path_.c_str(), &state), 0);
  EXPECT_EQ(state.st_mode & 0777, 0660u);
}

TEST_F(Server, AnswersKeepTheirOrder) {
  start();
  const int client = connect_to(path_);
  write(client, "later\nnext\n");
  ASSERT_TRUE(eventually([&] { return waiting_ != 0; }));
  EXPECT_EQ(ask(path_, "another"), "echo another") << "nobody else waits";
  server_->answer(waiting_, "at last");
  EXPECT_EQ(read_line(client), "at last");
  EXPECT_EQ(read_line(client), "echo next");
  close(client);
}

TEST_F(Server, AnAnswerForWhoHasGoneIsDropped) {
  start();
  const int client = connect_to(path_);
  write(client, "later\n");
  ASSERT_TRUE(eventually([&] { return waiting_ != 0; }));
  close(client);
  server_->answer(waiting_, "too late");
  EXPECT_EQ(ask(path_, "still"), "echo still");
}

TEST_F(Server, ALineThatIsTooLongIsCutOff) {
  start();
  const int client = connect_to(path_);
  const std::string much(100'000, 'x');
  write(client, much);
  char c = 0;
  EXPECT_LE(recv(client, &c, 1, 0), 0);
  EXPECT_EQ(counters_.get("clients_cut_off"), 1u);
  EXPECT_EQ(ask(path_, "still"), "echo still");
  close(client);
}

TEST_F(Server, SilentAndSlowClientsAreCutOff) {
  start({16, 0.3});
  const int silent = connect_to(path_), slow = connect_to(path_);
  ASSERT_TRUE(eventually([&] {
    write(slow, "x");  // byte by byte, never a line
    return counters_.get("clients_cut_off") == 2;
  }));
  EXPECT_EQ(ask(path_, "still"), "echo still");
  close(silent);
  close(slow);
}

TEST_F(Server, AClientThatTakesNoAnswersIsCutOff) {
  start({16, 30});
  const int client = connect_to(path_);
  timeval limit{0, 100'000};
  setsockopt(client, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
  const std::string line = std::string(60'000, 'x') + "\n";
  EXPECT_TRUE(eventually([&] {
    write(client, line);
    return counters_.get("clients_cut_off") == 1;
  }));
  close(client);
}

TEST_F(Server, OnlySoManyClients) {
  start({2, 60});
  const int a = connect_to(path_), b = connect_to(path_);
  ASSERT_TRUE(eventually([&] { return counters_.get("clients") == 2; }));
  EXPECT_EQ(ask(path_, "third"), "");
  EXPECT_EQ(counters_.get("clients_turned_away"), 1u);
  close(a);
  EXPECT_TRUE(eventually([&] { return ask(path_, "now") == "echo now"; }));
  close(b);
}

TEST_F(Server, TwoOnOneSocketIsAnError) {
  start();
  EXPECT_THROW(ListeningSocket::on_file(path_), InputError);
  EXPECT_EQ(ask(path_, "still"), "echo still");
}

TEST_F(Server, WhatAKilledDaemonLeftIsReplaced) {
  {
    const int left = socket(AF_UNIX, SOCK_STREAM, 0);
    close(left);
  }
  start();
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(path_)) << "removed at the end";
  start();
  EXPECT_EQ(ask(path_, "again"), "echo again");
}

TEST_F(Server, AFileInItsPlaceStays) {
  std::ofstream(path_) << "precious";
  EXPECT_THROW(ListeningSocket::on_file(path_), InputError);
  EXPECT_EQ(test::read_text(path_), "precious");
}

}  // namespace
}  // namespace edgepose
