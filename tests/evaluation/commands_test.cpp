/// `edgepose eval` and `edgepose study` as processes.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdio>
#include <fstream>

#include "files/bop_results.h"
#include "tests/evaluation/rendered_set.h"

namespace edgepose {
namespace {

struct Outcome {
  int code = -1;
  std::string text;  ///< stdout and stderr
};

Outcome run(const std::string& arguments) {
  Outcome outcome;
  FILE* pipe = popen(("'" EDGEPOSE_PROGRAM_DIR "/edgepose' " + arguments + " 2>&1").c_str(), "r");
  if (!pipe) return outcome;
  char buffer[4096];
  while (size_t n = fread(buffer, 1, sizeof buffer, pipe)) outcome.text.append(buffer, n);
  const int status = pclose(pipe);
  outcome.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

class Commands : public ::testing::Test {
 protected:
  RenderedSet rendered;
  std::string set = "'" + rendered.folder.string() + "'";
};

TEST_F(Commands, EvalPrintsTablesWithoutAnyFile) {
  const Outcome outcome = run("eval " + set);
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("| stairs "), std::string::npos) << outcome.text;
  EXPECT_NE(outcome.text.find("MR, all instances pooled"), std::string::npos) << outcome.text;
  EXPECT_EQ(outcome.text.find('\r'), std::string::npos) << "no progress bar where there is no terminal";
}

TEST_F(Commands, EvalWritesOneRowForEachListedObject) {
  const auto results = rendered.folder / "out.csv";
  const Outcome outcome = run("eval " + set + " --results '" + results.string() + "' --group-by-modulo 2");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("image number mod 2"), std::string::npos) << outcome.text;
  EXPECT_EQ(read_bop_results(results).size(), 3u);
}

/// The lines of a BOP result file without the times, which no two runs share.
std::string without_times(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string line, text;
  while (std::getline(file, line)) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

TEST_F(Commands, ShardsMergedAreTheWholeRunBitForBit) {
  for (const std::string options : {"", " --all-models"}) {
    const auto file = [&](const std::string& name) { return "'" + (rendered.folder / name).string() + "'"; };
    ASSERT_EQ(run("eval " + set + options + " --results " + file("whole.csv")).code, 0);
    for (const std::string part : {"1", "2", "3"}) {
      const Outcome outcome = run("eval " + set + options + " --threads " + part + " --shard " + part +
                                  "/3 --results " + file("part_" + part + ".shard"));
      ASSERT_EQ(outcome.code, 0) << outcome.text;
    }
    const std::string parts = " " + file("part_3.shard") + " " + file("part_1.shard");
    const Outcome lacking = run("merge" + parts);
    EXPECT_EQ(lacking.code, 2);
    EXPECT_NE(lacking.text.find("no part 2"), std::string::npos) << lacking.text;
    const Outcome merged =
        run("merge" + parts + " " + file("part_2.shard") + " --results " + file("merged.csv"));
    EXPECT_EQ(merged.code, 0) << merged.text;
    EXPECT_NE(merged.text.find("MR, all instances pooled"), std::string::npos) << merged.text;
    EXPECT_EQ(without_times(rendered.folder / "merged.csv"), without_times(rendered.folder / "whole.csv"));
    EXPECT_GT(without_times(rendered.folder / "whole.csv").size(), 200u);
  }
}

TEST_F(Commands, ShardsOfASetThatWasChangedAreNotMerged) {
  const std::string part = "'" + (rendered.folder / "part.shard").string() + "'";
  ASSERT_EQ(run("eval " + set + " --images 1 --shard 1/1 --results " + part).code, 0);
  ASSERT_EQ(run("merge " + part).code, 0);
  std::ofstream(rendered.folder / "test" / "000001" / "scene_gt.json", std::ios::app) << "\n";
  const Outcome changed = run("merge " + part);
  EXPECT_EQ(changed.code, 2);
  EXPECT_NE(changed.text.find("with other files"), std::string::npos) << changed.text;
}

TEST_F(Commands, AWrongShardIsBadInput) {
  for (const std::string wrong :
       {"--shard 3/2 --results x", "--shard 1/2", "--shard 1/2 --results x --report y"}) {
    const Outcome outcome = run("eval " + set + " " + wrong);
    EXPECT_EQ(outcome.code, 2) << wrong;
    EXPECT_NE(outcome.text.find("--shard"), std::string::npos) << outcome.text;
  }
}

TEST_F(Commands, EvalOfAllModelsWritesWhatIsThere) {
  const auto results = rendered.folder / "out.csv";
  const Outcome outcome = run("eval " + set + " --all-models --results '" + results.string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("0 of 1 (0.00 %)"), std::string::npos) << outcome.text;
  const auto rows = read_bop_results(results);
  EXPECT_EQ(rows.size(), 3u);
  for (const BopResult& row : rows) EXPECT_FALSE(row.image_id == 1 && row.object_id == 2);
}

TEST_F(Commands, EvalOfAllModelsGivesOneNameToOneThing) {
  // A third object that looks like the first: both cannot be what is seen.
  const auto models = rendered.folder / "models";
  std::filesystem::copy(models / "obj_000001.ply", models / "obj_000003.ply");
  std::ofstream(models / "models_info.json")
      << R"({"1": {"diameter": 200}, "2": {"diameter": 210}, "3": {"diameter": 200}})";
  const auto results = rendered.folder / "out.csv";
  const Outcome outcome =
      run("eval " + set + " --all-models --images 1 --results '" + results.string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(read_bop_results(results).size(), 1u);
}

TEST_F(Commands, EvalInPaperModeAlwaysAnswers) {
  const auto results = rendered.folder / "out.csv";
  const Outcome outcome = run("eval " + set + " --paper-mode --results '" + results.string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_EQ(read_bop_results(results).size(), 3u);
}

TEST_F(Commands, EvalTakesAPartOfTheSet) {
  const auto results = rendered.folder / "out.csv";
  const Outcome outcome =
      run("eval " + set + " --objects stairs --images 1 --threads 1 --results '" + results.string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const auto rows = read_bop_results(results);
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].image_id, 1);
  EXPECT_EQ(rows[0].object_id, 1);
  EXPECT_GT(rows[0].time, 0);
}

TEST_F(Commands, StudyWritesATableAtOnce) {
  const auto report = rendered.folder / "study";
  const Outcome outcome =
      run("study " + set + " --objects 1 --images 1 --experiment verification --report '" + report.string() +
          "'");
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  EXPECT_NE(outcome.text.find("edge score S (paper)"), std::string::npos) << outcome.text;
  EXPECT_TRUE(std::filesystem::exists(report / "study.md"));
}

TEST_F(Commands, BadInputIsOneLineAndExitCodeTwo) {
  std::ofstream(rendered.folder / "file") << "x";
  const std::string file = "'" + (rendered.folder / "file").string() + "'";
  for (const std::string& arguments :
       {std::string("eval"), std::string("eval /no/such/set"), "eval " + set + " --images 7-3",
        "eval " + set + " --images 5", "eval " + set + " --objects cone", "eval " + set + " --threads -1",
        "eval " + set + " --group-by-modulo 0", "eval " + set + " --results /no/such/folder/out.csv",
        "eval " + set + " --report " + file, "eval " + set + " --report /proc/report",
        "study " + set + " --report /proc/report",
        "eval " + set + " --results '" + (rendered.folder / "test/000001/depth/000001.png").string() + "'",
        "eval " + set + " --config /no/such.toml", std::string("study"),
        "study " + set + " --experiment colour", "study " + file}) {
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments << "\n" << outcome.text;
    EXPECT_EQ(std::count(outcome.text.begin(), outcome.text.end(), '\n'), 1) << arguments << "\n"
                                                                             << outcome.text;
  }
}

TEST_F(Commands, ADamagedSetIsRefused) {
  std::ofstream(rendered.folder / "test" / "000001" / "depth" / "000001.png") << "no PNG";
  const auto report = rendered.folder / "new" / "report";
  const Outcome outcome = run("eval " + set + " --report '" + report.string() + "'");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_FALSE(std::filesystem::exists(rendered.folder / "new")) << "an empty folder is left";
  EXPECT_NE(outcome.text.find("000001.png"), std::string::npos) << outcome.text;
}

}  // namespace
}  // namespace edgepose
