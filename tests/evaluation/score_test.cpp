#include "evaluation/score.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "evaluation/report.h"
#include "tests/evaluation/tiny_set.h"

namespace edgepose {
namespace {

Scores score(const std::vector<EvalRow>& rows, bool only_accepted = false) {
  return score_results(tiny_set(), tiny_errors(), rows, only_accepted);
}

TEST(Score, CountsCorrectPosesAtEachThreshold) {
  // Errors of 0.01, 0.03 and 0.07 diameters.
  const Scores scores = score({answer(0, 1, 0.001), answer(1, 1, 0.003), answer(0, 2, 0.007)});
  EXPECT_EQ(scores.pooled.instances, 3u);
  EXPECT_EQ(scores.pooled.correct, (std::array<size_t, 3>{1, 2, 3}));
  EXPECT_EQ(scores.objects.at(1).correct, (std::array<size_t, 3>{1, 2, 2}));
  EXPECT_EQ(scores.objects.at(2).correct, (std::array<size_t, 3>{0, 0, 1}));
  EXPECT_DOUBLE_EQ(scores.mean_recall[0], (0.5 + 0.0) / 2);
  EXPECT_DOUBLE_EQ(scores.mean_recall[1], (1.0 + 0.0) / 2);
  EXPECT_NEAR(scores.median_error, 0.002, 1e-9) << "of those correct at 0.05 d";
}

TEST(Score, AnErrorAtTheThresholdIsNotCorrect) {
  InstanceScore instance;
  instance.diameter = 1;
  instance.error = 0.05;
  EXPECT_FALSE(instance.correct(0.05));
  EXPECT_TRUE(instance.correct(0.1));
}

TEST(Score, TheAnswerWithTheBestScoreCountsAndTheFirstOfEquals) {
  EXPECT_EQ(score({answer(0, 1, 0.001, 0.5), answer(0, 1, 0.09, 0.6)}).pooled.correct[0], 0u);
  EXPECT_EQ(score({answer(0, 1, 0.001, 0.7), answer(0, 1, 0.09, 0.6)}).pooled.correct[0], 1u);
  EXPECT_EQ(score({answer(0, 1, 0.001, 0.6), answer(0, 1, 0.09, 0.6)}).pooled.correct[0], 1u);
}

TEST(Score, NoAnswerIsWrong) {
  EvalRow nothing = answer(0, 1, 0);
  nothing.found = false;
  const Scores scores = score({nothing});
  EXPECT_EQ(scores.pooled.instances, 3u);
  EXPECT_EQ(scores.pooled.correct[2], 0u);
  EXPECT_EQ(scores.time.count, 1u) << "but its time counts";
}

TEST(Score, AbsentObjectsReportedAreFalsePositives) {
  const Scores scores = score({answer(1, 2, 0), answer(0, 1, 0)});
  EXPECT_EQ(scores.absent_pairs, 1u);
  EXPECT_EQ(scores.false_positives, 1u);
  EXPECT_EQ(score({answer(1, 2, 0, 0.1, false)}).false_positives, 0u) << "not accepted: not reported";
  EXPECT_EQ(score({answer(7, 2, 0)}).false_positives, 0u) << "an image that is not in the set";
}

TEST(Score, AcceptanceIsCountedAmongTheCorrectOnes) {
  const std::vector<EvalRow> rows = {answer(0, 1, 0.001), answer(1, 1, 0.001, 0.2, false), answer(0, 2, 0.5)};
  const Scores scores = score(rows);
  EXPECT_EQ(scores.pooled.correct[1], 2u);
  EXPECT_EQ(scores.pooled.correct_accepted[1], 1u);
  const Scores accepted = score(rows, true);
  EXPECT_EQ(accepted.pooled.correct[1], 1u);
  EXPECT_EQ(accepted.best_guesses.correct[1], 2u);
  EXPECT_EQ(accepted.best_guesses.correct_accepted[1], 1u);
}

TEST(Score, InstancesWithFewVisiblePixelsAreLeftOutButAreNotAbsent) {
  TestSet set = tiny_set();
  set.images[0].truth[1].visible_pixels = 149;
  const Scores scores = score_results(set, tiny_errors(), {answer(0, 2, 0)});
  EXPECT_EQ(scores.pooled.instances, 2u);
  EXPECT_EQ(scores.objects.count(2), 0u);
  EXPECT_EQ(scores.false_positives, 0u);
  EXPECT_EQ(scores.absent_pairs, 1u);
  set.images[0].truth[1].visible_pixels = 150;
  EXPECT_EQ(score_results(set, tiny_errors(), {}).pooled.instances, 3u);
}

TEST(Score, TimesAreOfAllQuestions) {
  std::vector<EvalRow> rows = {answer(0, 1, 0), answer(1, 1, 0), answer(0, 2, 0)};
  rows[0].seconds = 0.1;
  rows[1].seconds = 0.2;
  rows[2].seconds = 0.9;
  const TimeFigures time = score(rows).time;
  EXPECT_EQ(time.count, 3u);
  EXPECT_DOUBLE_EQ(time.median, 0.2);
  EXPECT_DOUBLE_EQ(time.mean, 0.4);
  EXPECT_NEAR(time.p95, 0.83, 1e-12);
}

TEST(Score, GroupsByImageNumber) {
  const Scores scores = score({answer(0, 1, 0), answer(1, 1, 0.5), answer(0, 2, 0.004)});
  const auto groups = recall_by_image_modulo(scores, 2);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].instances, 2u);
  EXPECT_EQ(groups[0].correct[1], 2u);
  EXPECT_EQ(groups[1].instances, 1u);
  EXPECT_EQ(groups[1].correct[1], 0u);
  EXPECT_THROW(recall_by_image_modulo(scores, 0), std::invalid_argument);
}

TEST(Score, SurvivesTheWayThroughAResultFile) {
  const std::vector<EvalRow> rows = {answer(0, 1, 0.001), answer(1, 1, 0.001, 0.2, false), answer(0, 2, 0.5)};
  EXPECT_EQ(to_bop_results(rows, true).size(), 2u);
  const auto back =
      from_bop_results(parse_bop_results(format_bop_results(to_bop_results(rows, false)), "text"));
  ASSERT_EQ(back.size(), 3u);
  EXPECT_EQ(score(back).pooled.correct, score(rows).pooled.correct);
  EXPECT_DOUBLE_EQ(back[0].seconds, 0.1);
}

TEST(ReportTables, ShowWhatWasScored) {
  const TestSet set = tiny_set();
  EvalOptions options;
  options.all_models = true;
  Evaluation evaluation;
  evaluation.rows = {answer(0, 1, 0.001), answer(1, 1, 0.003), answer(0, 2, 0.007), answer(1, 2, 0)};
  const Scores scores = score_results(set, tiny_errors(), evaluation.rows);
  const std::string text =
      result_tables({set, options.all_models, {}, evaluation, scores, 2, "edgepose eval"});
  EXPECT_NE(text.find("| plain "), std::string::npos) << text;
  EXPECT_NE(text.find(" ADI' |"), std::string::npos) << text;
  EXPECT_NE(text.find("1 of 1 (100.00 %)"), std::string::npos) << "false positives\n" << text;
  EXPECT_NE(text.find("image number mod 2"), std::string::npos) << text;
}

}  // namespace
}  // namespace edgepose
