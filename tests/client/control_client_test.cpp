#include "client/service/control_client.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "messaging/signed_command.h"
#include "tests/client/fake_daemon.h"

namespace edgepose {
namespace {

using nlohmann::json;
using test::FakeDaemon;
using testing::HasSubstr;

std::string reply_with(const json& result, const std::string& line) {
  return json{{"jsonrpc", "2.0"}, {"id", json::parse(line).at("id")}, {"result", result}}.dump() + "\n";
}

/// What the client says of an answer.
std::string fault(const std::string& answer, double timeout = 10) {
  FakeDaemon daemon([&](const std::string&) { return answer; });
  try {
    ControlClient({daemon.path(), 0}, {}).call("status", nullptr, timeout);
  } catch (const ControlError& error) {
    return "code " + std::to_string(error.code()) + ": " + error.what();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ControlClient, RequestsAndResults) {
  FakeDaemon daemon([](const std::string& line) { return reply_with({{"echo", json::parse(line)}}, line); });
  ControlClient client({daemon.path(), 0}, {});
  const json first = client.call("models.get", {{"name", "l3"}}, 10).at("echo");
  EXPECT_EQ(first.at("jsonrpc"), "2.0");
  EXPECT_EQ(first.at("method"), "models.get");
  EXPECT_EQ(first.at("params").at("name"), "l3");
  const json second = client.call("status", nullptr, 10).at("echo");
  EXPECT_FALSE(second.contains("params"));
  EXPECT_NE(second.at("id"), first.at("id"));
}

TEST(ControlClient, AnAnswerInPiecesAndALongOne) {
  FakeDaemon daemon([](const std::string& line) { return reply_with(std::string(3'000'000, 'x'), line); });
  const json result = ControlClient({daemon.path(), 0}, {}).call("status", nullptr, 10);
  EXPECT_EQ(result.get<std::string>().size(), 3'000'000u);
}

TEST(ControlClient, TheDaemonsErrorIsPassedOn) {
  EXPECT_EQ(fault(R"({"jsonrpc":"2.0","id":1,"error":{"code":2,"message":"no model 'l4'; did you mean l3?"}})"
                  "\n"),
            "code 2: no model 'l4'; did you mean l3?");
  EXPECT_THAT(fault("{\"error\":{\"code\":1,\"message\":\"two\\nlines\"}}\n"), HasSubstr("two lines"));
}

TEST(ControlClient, AnswersThatAreNoneAreRefused) {
  for (const char* answer : {"nonsense\n", "[]\n", "{}\n", "\n", "{\"id\":1}\n", "{\"id\":2,\"result\":1}\n",
                             "{\"id\":\"1\",\"result\":1}\n", "{\"error\":3}\n", "{\"error\":{}}\n"})
    EXPECT_THAT(fault(answer), HasSubstr("JSON-RPC")) << answer;
  EXPECT_THAT(fault(std::string(100'000, '[') + "\n"), HasSubstr("JSON-RPC"));
  EXPECT_THAT(fault(std::string(17 << 20, 'x')), HasSubstr("16 MiB"));
}

TEST(ControlClient, SilenceEndsWithTheTimeout) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_THAT(fault("", 0.2), HasSubstr("--timeout"));
  EXPECT_THAT(fault("{\"id\":1,", 0.2), HasSubstr("--timeout")) << "half an answer";
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(ControlClient, AConnectionThatIsClosedIsTold) {
  FakeDaemon daemon([](const std::string&) { return ""; }, true);
  ControlClient client({daemon.path(), 0}, {});
  try {
    client.call("status", nullptr, 10);
    FAIL() << "an answer from nobody";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::AnyOf(HasSubstr("closed"), HasSubstr("reset")));
  }
}

TEST(ControlClient, WithoutADaemonItSaysWhereAndHowToStartIt) {
  try {
    ControlClient({"/nonexistent/control.sock", 0}, {});
    FAIL() << "connected to nothing";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                testing::AllOf(HasSubstr("/nonexistent/control.sock"), HasSubstr("edgeposed --config")));
  }
  EXPECT_THROW(ControlClient({std::string(200, 'a'), 0}, {}), InputError);
  EXPECT_THROW(ControlClient({"", 1}, {}), InputError) << "nobody listens on TCP port 1";
}

TEST(ControlClient, WhatChangesSomethingIsSigned) {
  const SecretKey key = SecretKey::random();
  CommandVerifier verifier(key, 0);
  std::vector<CommandFault> verdicts;
  FakeDaemon daemon([&](const std::string& line) {
    SignedCommand command;
    if (!parse_signed_command(line, command).empty()) return reply_with("plain", line);
    verdicts.push_back(verifier.judge(command, command.utime));
    return reply_with("signed", command.text);
  });
  ControlClient client({daemon.path(), 0}, key);
  EXPECT_EQ(client.call("models.list", nullptr, 10), "plain");
  EXPECT_EQ(client.call("models.unregister", {{"name", "l3"}}, 10), "signed");
  EXPECT_EQ(client.call("models.activate", {{"name", "l3"}}, 10), "signed");
  EXPECT_THAT(verdicts, testing::ElementsAre(CommandFault::kNone, CommandFault::kNone));
}

TEST(ControlClient, RequestsThatNoDaemonTakesAreNotSent) {
  FakeDaemon daemon([](const std::string& line) { return reply_with(1, line); });
  ControlClient client({daemon.path(), 0}, {});
  EXPECT_THROW(client.call("detect", {{"depth", std::string(70'000, 'x')}}, 10), InputError);
  EXPECT_THROW(client.call("detect", {{"depth", "\xff"}}, 10), InputError);
  EXPECT_TRUE(daemon.requests().empty());
}

TEST(ControlClient, WhileItWaitsItSaysHowLong) {
  std::atomic<bool> told = false;
  FakeDaemon daemon([&](const std::string& line) {
    while (!told) std::this_thread::yield();
    return reply_with(1, line);
  });
  ControlClient({daemon.path(), 0}, {}).call("status", nullptr, 10, [&](double seconds) {
    told = seconds > 0.05;
  });
  EXPECT_TRUE(told);
}

}  // namespace
}  // namespace edgepose
