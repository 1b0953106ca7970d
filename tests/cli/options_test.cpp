#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

using testing::HasSubstr;

TEST(CliOptions, VersionAndHelpGoToStdoutAndAreFine) {
  const Finished version = edgepose({"--version"});
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("edgepose [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  const Finished help = edgepose({"--help"});
  EXPECT_EQ(help.code, 0);
  EXPECT_THAT(help.out, HasSubstr("Examples:"));
  EXPECT_EQ(help.err, "");
}

class CliHelp : public testing::TestWithParam<std::string> {};

TEST_P(CliHelp, NamesEachCommandWithExamples) {
  EXPECT_THAT(edgepose({"--help"}).out, HasSubstr("  " + GetParam() + " "));
  const Finished run = edgepose({GetParam(), "--help"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, HasSubstr("Examples:"));
  EXPECT_THAT(run.out, HasSubstr("edgepose " + GetParam() + " "));
}

INSTANTIATE_TEST_SUITE_P(Commands, CliHelp,
                         testing::Values("train", "info", "match", "eval", "study", "render"));

TEST(CliOptions, WrongUsageIsBadInputAndNamesTheOption) {
  expect_refused(edgepose({}), {"subcommand", "--help"});
  expect_refused(edgepose({"dance"}), {"dance"});
  expect_refused(edgepose({"mach", "m"}), {"'mach'", "match"});
  expect_refused(edgepose({"train"}), {"MESH"});
  expect_refused(edgepose({"train", "a.ply"}), {"--output"});
  expect_refused(edgepose({"train", "a.ply", "-o", "m", "--unit", "inch"}), {"--unit"});
  expect_refused(edgepose({"train", "a.ply", "-o", "m", "--threads", "-1"}), {"--threads"});
  expect_refused(edgepose({"train", "a.ply", "-o", "m", "--symmetries", "i.json"}), {"--object-id"});
  expect_refused(edgepose({"match", "m", "--depth", "d.png", "--cloud", "c.ply"}), {"--cloud", "--depth"});
  expect_refused(edgepose({"match", "m", "--intrinsics", "1,1,0,0"}), {"--intrinsics", "--depth"});
  expect_refused(edgepose({"match", "m"}), {"--depth", "--cloud"});
  expect_refused(edgepose({"match", "m", "--cloud", "c.ply", "--viewpoint", "1,2"}), {"--viewpoint"});
  expect_refused(edgepose({"match", "m", "--cloud", "c.ply", "--max-instances", "0"}), {"--max-instances"});
  expect_refused(edgepose({"match", "m", "--cloud", "c.ply", "--max-instances", "101"}),
                 {"--max-instances", "100"});
  expect_refused(edgepose({"match", "m", "--cloud", "c.ply", "--accept", "nan"}), {"--accept", "nan"});
  expect_refused(edgepose({"match", "m", "--depth", "d.png", "--depth-scale", "0"}), {"--depth-scale"});
  expect_refused(edgepose({"match", "m", "--cloud", "c.ply", "--accept", "2"}), {"--accept"});
  expect_refused(edgepose({"info"}), {"FILE"});
}

TEST(CliOptions, AnEmptyValueIsNoValue) {
  expect_refused(edgepose({"eval", "set", "--shard", "", "--results", "r"}),
                 {"--shard", "empty", "edgepose eval --help"});
  expect_refused(edgepose({"eval", "set", "--images", ""}), {"--images", "empty"});
  expect_refused(edgepose({"eval", ""}), {"SET", "empty"});
  expect_refused(edgepose({"merge", "a.shard", "--set", ""}), {"--set", "empty"});
  expect_refused(edgepose({"merge", "a.shard", ""}), {"SHARD", "empty"});
  expect_refused(edgepose({"match", "", "--depth", "d.png"}), {"MODEL", "empty"});
}

TEST(CliOptions, WhatIsUnknownIsNamedFirstWithItsCommandsHelp) {
  expect_refused(edgepose({"merge", "a.shard", "--deadline-ms", "0"}),
                 {"no option is called '--deadline-ms'", "edgepose merge --help"});
  expect_refused(edgepose({"models", "add", "a.ply", "--nam", "a"}),
                 {"did you mean --name?", "edgepose models add --help"});
  expect_refused(edgepose({"train", "a.ply", "-o", "m", "--threads", "abc"}),
                 {"--threads: expected a whole number", "'abc'"});
  expect_refused(edgepose({"train", "a.ply", "-o", "m", "--unit", "inch"}),
                 {"--unit: expected m|mm, found 'inch'"});
}

TEST(CliOptions, ConfigurationIsReadAndItsFaultsAreNamed) {
  const Folder folder;
  const std::string mesh = folder.write("bracket.ply", bracket_ply(100));
  const auto train = [&](const std::string& config) {
    return edgepose({"train", mesh, "-o", folder / "m", "--config", folder.write("c.toml", config)});
  };
  expect_refused(train("[train]\nsampling_stp = 0.05\n"),
                 {"c.toml:2", "train.sampling_stp", "train.sampling_step"});
  expect_refused(train("[train]\nviews = \"many\"\n"), {"c.toml:2", "train.views", "integer", "many"});
  expect_refused(train("[train\n"), {"c.toml:1"});
  expect_refused(train("[match]\nverification = \"guess\"\n"), {"match.verification", "free_space", "guess"});
  expect_refused(train("[train]\nsampling_step = -1\n"), {"c.toml", "sampling_step"});
  expect_refused(edgepose({"train", mesh, "-o", folder / "m", "--config", folder / "no.toml"}), {"no.toml"});
  EXPECT_THAT(folder.files(), testing::ElementsAre("bracket.ply", "c.toml"));
}

}  // namespace
}  // namespace edgepose::test
