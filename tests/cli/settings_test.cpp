#include "settings/matcher_settings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <toml++/toml.h>
#include <array>
#include <fstream>
#include <regex>
#include <sstream>

#include "client/cli/set_input.h"
#include "common/error.h"
#include "common/nearest_word.h"

namespace edgepose::test {
namespace {

std::string source(const std::string& name) {
  std::ostringstream text;
  text << std::ifstream(std::filesystem::path(EDGEPOSE_SOURCE_DIR) / name).rdbuf();
  return text.str();
}

/// The sample with every commented key taken in.
std::string uncommented() {
  return std::regex_replace(source("config/edgepose.toml"), std::regex("(^|\n)# ([a-z_]+ = )"), "$1$2");
}

std::filesystem::path temporary(const std::string& text) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "edgepose_settings_test.toml";
  std::ofstream(path) << text;
  return path;
}

TEST(Settings, WhatIsShownOfAFileDoesNothingToTheTerminal) {
  try {
    parse_settings("\"a\\u001b[31mb\\rc\" = 1", "x.toml");
    FAIL() << "an unknown key";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_THAT(message, testing::HasSubstr("[31mb"));
    EXPECT_TRUE(std::all_of(message.begin(), message.end(), [](unsigned char c) { return c >= ' '; }))
        << testing::PrintToString(message);
  }
}

TEST(Settings, AnEmptyFileChangesNothing) {
  const Settings settings = read_settings(temporary(""));
  EXPECT_EQ(settings.match.accept_score, MatchOptions().accept_score);
}

TEST(Settings, TheSampleNamesEveryKeyWithItsDefault) {
  const toml::table sample = toml::parse(uncommented());
  Settings defaults;
  Settings changed = read_settings(temporary(uncommented()));
  size_t keys = 0;
  for (const SettingKey& key : setting_keys(defaults)) {
    const auto node = sample.at_path(key.path);
    ASSERT_TRUE(node) << key.path << " is missing in config/edgepose.toml";
    for (const SettingKey& read : setting_keys(changed)) {
      if (read.path == key.path) {
        EXPECT_EQ(to_toml(read), to_toml(key)) << key.path;
      }
    }
    ++keys;
  }
  size_t in_sample = 0;
  for (const auto& [section, table] : sample) {
    for (const auto& [name, node] : *table.as_table())
      in_sample += node.is_table() ? node.as_table()->size() : 1;
  }
  EXPECT_EQ(in_sample, keys);
}

/// Fields of the option structs, read from the headers: a new one needs a key.
TEST(Settings, EveryOptionOfTheMatcherHasAKey) {
  Settings settings;
  std::vector<std::string> paths;
  for (const SettingKey& key : setting_keys(settings)) paths.push_back(key.path);
  const std::vector<std::array<std::string, 3>> structs = {
      {"matcher/model.h", "TrainOptions", "train."},
      {"matcher/scene.h", "SceneOptions", "scene."},
      {"matcher/match_options.h", "MatchOptions", "match."},
      {"matcher/match_options.h", "SamplingOptions", "match.sampling."},
      {"matcher/match_options.h", "VotingOptions", "match.voting."},
      {"matcher/match_options.h", "ClusteringOptions", "match.clustering."},
      {"matcher/match_options.h", "SearchOptions", "match.search."},
      {"matcher/match_options.h", "ToleranceOptions", "match.tolerance."},
      {"matcher/match_options.h", "RefinementOptions", "match.refinement."},
      {"matcher/match_options.h", "PaperOptions", "match.paper."}};
  for (const auto& [header, name, prefix] : structs) {
    const std::string text = source(header);
    const size_t begin = text.find("struct " + name + " {");
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string body = text.substr(begin, text.find("\n};", begin) - begin);
    const std::regex field("\n  [A-Za-z_0-9:]+ ([a-z_0-9]+) *= *[^=;][^;]*;");
    size_t fields = 0;
    for (auto it = std::sregex_iterator(body.begin(), body.end(), field); it != std::sregex_iterator();
         ++it) {
      EXPECT_THAT(paths, testing::Contains(prefix + (*it)[1].str()));
      ++fields;
    }
    EXPECT_GE(fields, 2u) << name;
  }
}

TEST(Settings, AFileOverridesOnlyWhatItNames) {
  const Settings settings = read_settings(
      temporary("[match]\naccept_score = 0.25\nverification = \"paper\"\n[match.paper]\ncandidates = 5\n"));
  EXPECT_FLOAT_EQ(settings.match.accept_score, 0.25f);
  EXPECT_EQ(settings.match.verification, Verification::kPaper);
  EXPECT_EQ(settings.match.paper.candidates, 5);
  EXPECT_EQ(settings.match.max_instances, MatchOptions{}.max_instances);
}

TEST(Settings, ThreadsOfTheFileStandUnlessTheOptionIsGiven) {
  SetInput input;
  input.config = temporary("[train]\nthreads = 3\n[match]\nthreads = 2\n");
  EXPECT_FALSE(input.options().threads.has_value());
  EXPECT_EQ(input.options().train.threads, 3);
  EXPECT_EQ(input.options().match.threads, 2);
  input.threads = 1;
  EXPECT_EQ(input.options().threads, 1);
}

TEST(NearestWord, HasTheFewestChanges) {
  EXPECT_EQ(nearest_word("tread", {"threads", "views", "seed"}), "threads");
  EXPECT_EQ(nearest_word("seed", {"threads", "seeds", "seed"}), "seed");
  EXPECT_EQ(nearest_word("x", {}), "");
}

}  // namespace
}  // namespace edgepose::test
