/// The commands that talk to the daemon, and keygen, as a user runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "messaging/authentication.h"
#include "tests/client/child.h"
#include "tests/client/fake_daemon.h"

namespace edgepose::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

std::string reply_with(const json& result, const std::string& line) {
  return json{{"jsonrpc", "2.0"}, {"id", json::parse(line).at("id")}, {"result", result}}.dump() + "\n";
}

/// Runs a command against a daemon that always gives this result.
struct Asked {
  Finished run;
  json request;
};
Asked ask(std::vector<std::string> arguments, const json& result) {
  FakeDaemon daemon([&](const std::string& line) { return reply_with(result, line); });
  arguments.insert(arguments.end(), {"--socket", daemon.path()});
  Asked asked{edgepose(arguments), {}};
  const auto requests = daemon.requests();
  if (!requests.empty()) asked.request = json::parse(requests.front());
  return asked;
}

const json kModel = {
    {"name", "l3"},      {"active", true}, {"content_hash", 77}, {"diameter", 0.0987},
    {"points", 1234},    {"plan", 2},      {"symmetric", false}, {"registered_utime", 1'700'000'000'000'000},
    {"file", "l3.model"}};

TEST(ControlCommands, ModelsAsATableAndAsJson) {
  const Asked table = ask({"models", "list"}, json::array({kModel}));
  EXPECT_EQ(table.run.code, 0) << table.run.err;
  EXPECT_EQ(table.request.at("method"), "models.list");
  EXPECT_THAT(table.run.out, HasSubstr("98.7"));
  EXPECT_THAT(table.run.out, HasSubstr("2023-11-14 22:13:20"));
  EXPECT_EQ(json::parse(ask({"models", "list", "--json"}, json::array({kModel})).run.out),
            json::array({kModel}));
  EXPECT_THAT(ask({"models", "list"}, json::array()).run.out, HasSubstr("models add"));
}

TEST(ControlCommands, WhateverTheDaemonAnswersIsShownWithoutHarm) {
  for (const json& odd : {json(nullptr), json(3), json("text"), json::array({1, nullptr, json::array()}),
                          json::array({{{"name", {{"a", 1}}}, {"diameter", "x"}, {"active", "\033[2J"}}})})
    for (const auto& command : std::vector<std::vector<std::string>>{{"models", "list"},
                                                                     {"models", "show", "l3"},
                                                                     {"status"},
                                                                     {"status", "--stats"},
                                                                     {"status", "--settings"}}) {
      const Finished run = ask(command, odd).run;
      EXPECT_EQ(run.code, 0) << odd << run.err;
      EXPECT_EQ(run.out.find('\033'), std::string::npos);
    }
}

TEST(ControlCommands, AddSendsAbsolutePaths) {
  const std::string mesh = phantom_file("phantom.ply"), plan = phantom_file("drill_plan.json");
  const auto relative = std::filesystem::relative(mesh);
  const Asked added =
      ask({"models", "add", relative, "--name", "l3", "--plan", plan, "--unit", "m", "--inactive"}, kModel);
  ASSERT_EQ(added.run.code, 0) << added.run.err;
  const json params = added.request.at("params");
  EXPECT_EQ(params.at("mesh"), std::filesystem::canonical(mesh).string());
  EXPECT_EQ(params.at("plan"), std::filesystem::canonical(plan).string());
  EXPECT_EQ(params.at("unit"), "m");
  EXPECT_EQ(params.at("activate"), false);
  EXPECT_EQ(params.at("replace"), false);
  EXPECT_EQ(params.at("name"), "l3");
  expect_refused(ask({"models", "add", "/no/such.ply"}, kModel).run, {"/no/such.ply"});
}

TEST(ControlCommands, ActivateDeactivateRemove) {
  EXPECT_EQ(ask({"models", "activate", "l3"}, kModel).request.at("params"),
            (json{{"name", "l3"}, {"active", true}}));
  EXPECT_EQ(ask({"models", "deactivate", "l3"}, kModel).request.at("params"),
            (json{{"name", "l3"}, {"active", false}}));
  const Asked removed = ask({"models", "remove", "l3"}, {{"name", "l3"}});
  EXPECT_EQ(removed.request.at("method"), "models.unregister");
  EXPECT_EQ(removed.run.out, "removed: l3\n");
}

TEST(ControlCommands, StatusIsReadable) {
  const Asked status = ask({"status"}, {{"version", "0.1.0"},
                                        {"uptime", 12.3},
                                        {"ready", true},
                                        {"latency", {{"p50", 0.08}, {"p99", 0.12}, {"count", 7}}},
                                        {"last_frame", {{"camera", "left"}, {"sequence", 9}}}});
  EXPECT_EQ(status.run.code, 0) << status.run.err;
  EXPECT_THAT(status.run.out, HasSubstr("p50 80.0 ms, p99 120.0 ms, of 7 answers"));
  EXPECT_THAT(status.run.out, HasSubstr("left 9"));
  EXPECT_EQ(ask({"status", "--stats"}, json::object()).request.at("method"), "stats");
  EXPECT_EQ(ask({"status", "--settings"}, json::object()).request.at("method"), "config.get");
}

TEST(ControlCommands, DetectSaysFoundOrNotByItsExitCode) {
  const json detection = {{"translation_m", {0.01, 0.02, 0.5}}, {"score", 0.9}, {"accepted", true}};
  const json found = {{"models", {{{"model", "l3"}, {"found", true}, {"detections", {detection}}}}}};
  const Asked yes = ask({"detect", "--model", "l3"}, found);
  EXPECT_EQ(yes.run.code, 0) << yes.run.err;
  EXPECT_THAT(yes.run.out, HasSubstr("10.00    20.00   500.00   0.90"));
  EXPECT_EQ(yes.request.at("params").at("models"), json::array({"l3"}));
  const Asked no = ask(
      {"detect"},
      {{"models",
        {{{"model", "l3"}, {"found", false}, {"reason", "too few points"}, {"detections", json::array()}}}}});
  EXPECT_EQ(no.run.code, 1);
  EXPECT_THAT(no.run.out, HasSubstr("not found: too few points"));
  EXPECT_EQ(ask({"detect"}, nullptr).run.code, 1);
}

TEST(ControlCommands, TheDaemonsRefusalIsOneLine) {
  FakeDaemon daemon([](const std::string&) {
    return std::string(R"({"jsonrpc":"2.0","id":1,"error":{"code":3,"message":"l3: the name is taken"}})") +
           "\n";
  });
  expect_refused(edgepose({"models", "remove", "l3", "--socket", daemon.path()}), {"the name is taken"});
}

TEST(ControlCommands, WithoutADaemonOneLineSaysWhereAndWhatToDo) {
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"status"}, {"detect"}, {"models", "list"}}) {
    auto arguments = command;
    arguments.insert(arguments.end(), {"--socket", "/nonexistent/s"});
    expect_refused(edgepose(arguments), {"/nonexistent/s", "edgeposed --config FILE"});
  }
  expect_refused(edgepose({"status", "--tcp", "1"}), {"127.0.0.1:1"});
  expect_refused(edgepose({"models"}), {"subcommand"});
}

TEST(Keygen, WritesAKeyOnce) {
  const Folder folder;
  const std::string path = folder / "key";
  EXPECT_EQ(edgepose({"keygen", path}).code, 0);
  const auto bytes = SecretKey::read(path).bytes();
  expect_refused(edgepose({"keygen", path}), {path, "never replaced"});
  EXPECT_EQ(SecretKey::read(path).bytes(), bytes);
}

class ServiceHelp : public testing::TestWithParam<std::string> {};

TEST_P(ServiceHelp, HasExamples) {
  const Finished help = edgepose({GetParam(), "--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("Examples:\n  edgepose " + GetParam()));
  EXPECT_EQ(help.err, "");
}

INSTANTIATE_TEST_SUITE_P(All, ServiceHelp,
                         testing::Values("keygen", "models", "status", "detect", "send", "watch", "record",
                                         "replay", "compare"));

}  // namespace
}  // namespace edgepose::test
