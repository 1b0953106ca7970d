#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <toml++/toml.h>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>

#include "common/error.h"
#include "server/service_options.h"
#include "settings/control_address.h"

namespace edgepose::test {
namespace {

std::string sample() {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "config/edgeposed.toml").rdbuf();
  return text.str();
}

/// The sample with every commented key taken in.
std::string uncommented() { return std::regex_replace(sample(), std::regex("(^|\n)# ([a-z_]+ = )"), "$1$2"); }

/// What is said about `text`; empty if it is sound.
std::string fault_of(const std::string& text) {
  try {
    parse_service_options(text, "d.toml");
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

/// "live" or "restart", as the sample says behind each key or below it, by the key's path.
std::map<std::string, std::string> marks() {
  std::map<std::string, std::string> found;
  std::istringstream lines(sample());
  const std::regex section_line(R"(\[([a-z.]+)\].*)"), key_line("# ([a-z_]+) = .*"),
      mark(R"(.*# \[(live|restart)\].*)");
  std::string section, key;
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, section_line)) section = match[1].str() + ".";
    if (std::regex_match(line, match, key_line)) key = section + match[1].str();
    if (!key.empty() && std::regex_match(line, match, mark)) found.emplace(key, match[1].str());
  }
  return found;
}

size_t count_keys(const toml::table& table) {
  size_t count = 0;
  for (const auto& [name, node] : table) count += node.is_table() ? count_keys(*node.as_table()) : 1;
  return count;
}

TEST(ServiceConfig, TheSampleChangesNothingAsItIs) {
  ServiceOptions defaults, read = parse_service_options(sample(), "config/edgeposed.toml");
  const auto expected = service_keys(defaults), found = service_keys(read);
  for (size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(to_toml(found[i]), to_toml(expected[i]));
}

TEST(ServiceConfig, TheSampleNamesEveryKeyWithItsDefault) {
  const toml::table table = toml::parse(uncommented());
  ServiceOptions defaults, read = parse_service_options(uncommented(), "config/edgeposed.toml");
  const auto expected = service_keys(defaults), found = service_keys(read);
  for (size_t i = 0; i < expected.size(); ++i) {
    EXPECT_TRUE(table.at_path(expected[i].path))
        << expected[i].path << " is missing in config/edgeposed.toml";
    EXPECT_EQ(to_toml(found[i]), to_toml(expected[i])) << expected[i].path;
  }
  EXPECT_EQ(count_keys(table), expected.size());
}

TEST(ServiceConfig, TheSampleSaysWhatTakesEffectWhen) {
  ServiceOptions options;
  std::map<std::string, std::string> expected;
  for (const SettingKey& key : service_keys(options))
    expected[key.path] = is_live(key.path) ? "live" : "restart";
  EXPECT_EQ(marks(), expected);
  EXPECT_EQ(expected.at("service.lcm_url"), "restart");
  EXPECT_EQ(expected.at("match.accept_score"), "live");
}

TEST(ServiceConfig, EveryFileOfTheDaemonIsSound) {
  EXPECT_NO_THROW(read_service_options(std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "docker/edgeposed.toml"));
}

TEST(ServiceConfig, AMisspelledKeyIsNamedWithTheNearest) {
  EXPECT_THAT(fault_of("[service]\n\nhttp_prot = 8080\n"),
              testing::AllOf(testing::StartsWith("d.toml:3: "), testing::HasSubstr("service.http_prot"),
                             testing::HasSubstr("did you mean service.http_port?")));
  EXPECT_THAT(fault_of("[tracking]\ndetect_evry = 3\n"),
              testing::HasSubstr("did you mean tracking.detect_every?"));
}

TEST(ServiceConfig, AnUnknownSectionIsNamed) {
  EXPECT_THAT(fault_of("[serivce]\nhttp_port = 8080\n"),
              testing::AllOf(testing::StartsWith("d.toml:2: "), testing::HasSubstr("serivce.http_port"),
                             testing::HasSubstr("service.http_port?")));
}

TEST(ServiceConfig, AnotherTypeIsNamedWithTheLine) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[service]\nhttp_port = \"8080\"", "service.http_port = an integer"},
      {"[service]\nhttp_port = 80.5", "service.http_port = an integer"},
      {"[service]\nlcm_url = 7667", "service.lcm_url = text in quotes"},
      {"[service]\ndeadline = true", "service.deadline = a number"},
      {"[tracking]\nenabled = 1", "tracking.enabled = true or false"},
      {"[tracking]\nmargin = nan", "tracking.margin = a number"},
      {"[frames]\nmax_cameras = [1]", "frames.max_cameras = an integer"},
      {"[match]\nverification = \"none\"", "match.verification"},
      {"[service]\ndeadline = ", "TOML"}};
  for (const auto& [text, expected] : cases)
    EXPECT_THAT(fault_of(text),
                testing::AllOf(testing::StartsWith("d.toml:2: "), testing::HasSubstr(expected)))
        << text;
}

TEST(ServiceConfig, WhatIsOutOfRangeIsNamedWithItsField) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[service]\nhttp_port = 65536", "service.http_port: expected 0 to 65535, found 65536"},
      {"[service]\ncontrol_port = -1", "service.control_port"},
      {"[service]\ndeadline = -0.1", "service.deadline"},
      {"[service]\nclient_timeout = 0", "service.client_timeout"},
      {"[service]\nmax_clients = 0", "service.max_clients"},
      {"[service]\nlog_level = \"loud\"", "service.log_level: expected debug, info, warning or error"},
      {"[service]\nlcm_url = \"tcpq://\"", "service.lcm_url: "},
      {"[service]\nlcm_url = \"udpm://10.0.0.1:7667\"", "service.lcm_url: "},
      {"[frames]\nmax_age = 0", "frames.max_age"},
      {"[frames]\nmax_ahead = -1", "frames.max_ahead"},
      {"[frames]\nmax_cameras = 65", "frames.max_cameras"},
      {"[tracking]\ndetect_every = 0", "tracking.detect_every"},
      {"[tracking]\nmax_gap = -1", "tracking.max_gap"},
      {"[tracking]\nmargin = 11", "tracking.margin"},
      {"[training]\nmemory_mb = 63", "training.memory_mb"},
      {"[training]\nseconds = 0", "training.seconds"},
      {"[training]\nthreads = 0", "training.threads"},
      {"[match]\naccept_score = 1.5", "accept_score"}};
  for (const auto& [text, expected] : cases)
    EXPECT_THAT(fault_of(text), testing::AllOf(testing::StartsWith("d.toml: "), testing::HasSubstr(expected)))
        << text;
}

TEST(ServiceConfig, AFileThatCannotBeReadIsNamed) {
  try {
    read_service_options("/nowhere/edgeposed.toml");
    FAIL() << "no file";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith("/nowhere/edgeposed.toml"));
  }
}

/// Anybody may have made the folder in /tmp that is taken where there is no other.
TEST(ControlAddress, OfTheLastResortOnlyWhatIsOnesOwn) {
  const bool is_root = geteuid() == 0;
  ASSERT_EQ(is_root ? seteuid(65534) : 0, 0);
  for (const char* name : {"EDGEPOSE_SOCKET", "RUNTIME_DIRECTORY", "XDG_RUNTIME_DIR"}) unsetenv(name);
  const std::filesystem::path folder = "/tmp/edgepose-" + std::to_string(geteuid());
  if (std::filesystem::exists("/run/edgepose/control.sock") || !std::filesystem::create_directory(folder)) {
    ASSERT_EQ(is_root ? seteuid(0) : 0, 0);
    GTEST_SKIP() << "a daemon runs here, or " << folder << " is there already";
  }
  std::filesystem::permissions(folder, std::filesystem::perms(0700));
  EXPECT_EQ(default_control_socket(), folder / "control.sock");
  std::filesystem::permissions(folder, std::filesystem::perms(0777));
  EXPECT_THROW(default_control_socket(), InputError);
  std::filesystem::remove(folder);
  ASSERT_EQ(is_root ? seteuid(0) : 0, 0);
}

}  // namespace
}  // namespace edgepose::test
