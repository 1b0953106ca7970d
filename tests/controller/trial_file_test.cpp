#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "common/error.h"
#include "experiment/experiment.h"
#include "tests/temporary_folder.h"

namespace edgepose {
namespace {

class TrialFile : public testing::Test {
 protected:
  void write(const std::string& text) { std::ofstream(path_) << text; }
  std::vector<ArmResults> read(const std::string& made_with = "mesh a") {
    return read_trials(path_, made_with, arms_);
  }
  std::string fault() {
    try {
      read();
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  }

  const TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_ / "trials.csv";
  const std::vector<ExperimentArm> arms_ = standard_arms();
};

TEST_F(TrialFile, WhatWasWrittenIsReadAndHalfALineIsNot) {
  TrialResult trial;
  trial.seed = 7;
  trial.steps = 3;
  trial.error.translation = 0.00025;
  trial.end = "refused; why";
  trial.distances = {0.1, 0.01};
  const std::string line = trial_line(arms_[1], trial);
  write(trial_heading("mesh a") + line + "another row;1;2;0;0;0;0;end;;\n" + line.substr(0, line.size() - 1));
  const std::vector<ArmResults> results = read();
  ASSERT_EQ(results.size(), arms_.size());
  ASSERT_EQ(results[1].trials.size(), 1u);
  const TrialResult& found = results[1].trials[0];
  EXPECT_EQ(found.seed, 7u);
  EXPECT_EQ(found.steps, 3);
  EXPECT_EQ(found.error.translation, 0.00025);
  EXPECT_EQ(found.end, "refused, why");
  EXPECT_EQ(found.distances, trial.distances);
}

TEST_F(TrialFile, NoFileHasNoTrials) { EXPECT_TRUE(read().at(0).trials.empty()); }

TEST_F(TrialFile, TrialsOfAnotherMeshOrNoTrialsAreRefused) {
  write(trial_heading("mesh b"));
  EXPECT_THAT(fault(), testing::AllOf(testing::HasSubstr("mesh a"), testing::HasSubstr("mesh b")));
  write("something else\n");
  EXPECT_THAT(fault(), testing::HasSubstr("another file"));
}

}  // namespace
}  // namespace edgepose
