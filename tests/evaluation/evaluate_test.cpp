#include "evaluation/evaluate.h"

#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "common/error.h"
#include "evaluation/deadline.h"
#include "evaluation/report.h"
#include "evaluation/resources.h"
#include "tests/evaluation/rendered_set.h"

namespace edgepose {
namespace {

std::vector<std::pair<int, int>> questions(const Evaluation& evaluation) {
  std::vector<std::pair<int, int>> pairs;
  for (const EvalRow& row : evaluation.rows) pairs.emplace_back(row.image_id, row.object_id);
  return pairs;
}

/// Training takes a second or two: once for all tests.
class Evaluate : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    rendered = std::make_unique<RenderedSet>();
    models = train_models(rendered->set, {});
  }
  static void TearDownTestSuite() {
    models.clear();
    rendered.reset();
  }
  static inline std::unique_ptr<RenderedSet> rendered;
  static inline std::vector<TrainedModel> models;
};

TEST_F(Evaluate, AsksForListedObjectsAndScoresTheAnswers) {
  double last_progress = 0;
  const Evaluation evaluation = run_evaluation(rendered->set, models, {}, [&](double share) {
    EXPECT_GE(share, last_progress);
    last_progress = share;
  });
  EXPECT_EQ(last_progress, 1);
  EXPECT_EQ(questions(evaluation), (std::vector<std::pair<int, int>>{{0, 1}, {0, 2}, {1, 1}}));
  const Scores scores = score_results(rendered->set, make_pose_errors(rendered->set), evaluation.rows);
  EXPECT_EQ(scores.pooled.instances, 3u);
  EXPECT_EQ(scores.objects.at(1).correct[0], 2u) << "the stairs in plain view, twice";
  for (const EvalRow& row : evaluation.rows) {
    EXPECT_GT(row.preprocessing, 0);
    EXPECT_GE(row.seconds, row.preprocessing + row.stages.total() * 0.99);
  }
  EXPECT_EQ(evaluation.rows[0].preprocessing, evaluation.rows[1].preprocessing) << "shared by the two";
  EXPECT_GT(evaluation.cpu_seconds, 0);
  EXPECT_GT(evaluation.wall_seconds, 0);
  EXPECT_GT(evaluation.peak_memory_megabytes, 1);
}

TEST_F(Evaluate, AllModelsAsksForEveryPair) {
  EvalOptions options;
  options.all_models = true;
  const Evaluation evaluation = run_evaluation(rendered->set, models, options);
  EXPECT_EQ(questions(evaluation), (std::vector<std::pair<int, int>>{{0, 1}, {0, 2}, {1, 1}, {1, 2}}));
}

TEST_F(Evaluate, ThePoseIsTheSameAtAnyNumberOfThreads) {
  EvalOptions one, two;
  one.threads = 1;
  two.threads = 2;
  const Evaluation a = run_evaluation(rendered->set, models, one),
                   b = run_evaluation(rendered->set, models, two);
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (size_t i = 0; i < a.rows.size(); ++i) {
    EXPECT_EQ(a.rows[i].camera_T_model.matrix(), b.rows[i].camera_T_model.matrix()) << i;
    EXPECT_EQ(a.rows[i].score, b.rows[i].score) << i;
  }
}

TEST(Deadline, IsWhatPreprocessingLeavesOfIt) {
  MatchOptions options;
  options.max_seconds = 7;
  EXPECT_EQ(within_deadline(options, 0, 0.01).max_seconds, 7) << "none: nothing changes";
  EXPECT_DOUBLE_EQ(within_deadline(options, 0.05, 0.01).max_seconds, 0.04)
      << "it wins, also where it is more";
  const double least = within_deadline(options, 0.05, 0.06).max_seconds;
  EXPECT_GT(least, 0) << "0 would be no limit at all";
  EXPECT_LT(least, 1e-3);
  EXPECT_EQ(within_deadline(options, 3600, 0).check(), "");
}

TEST_F(Evaluate, TheDeadlineIsCheckedAndReachesTheMatcher) {
  EvalOptions options;
  options.match.search.sure_once = options.match.search.sure_twice = options.match.search.sure_thrice = 1.1f;
  options.deadline = 1e-6;
  for (const EvalRow& row : run_evaluation(rendered->set, models, options).rows)
    EXPECT_TRUE(row.cut_short) << row.image_id << " " << row.object_id;
  for (const double wrong : {-1.0, 1e9, std::numeric_limits<double>::quiet_NaN()}) {
    options.deadline = wrong;
    EXPECT_THROW(run_evaluation(rendered->set, models, options), InputError) << wrong;
  }
}

TEST_F(Evaluate, DisturbedImagesReachTheMatcher) {
  EvalOptions options;
  std::vector<int> seen;
  options.disturb = [&](const TestImage& image, const DepthImage& depth, const Camera& camera) {
    seen.push_back(image.image_id);
    EXPECT_EQ(camera.fx, 500);
    DepthImage farther = depth;
    for (float& z : farther.depth)
      if (z > 0) z += 0.05f;
    return farther;
  };
  const Evaluation evaluation = run_evaluation(rendered->set, models, options);
  EXPECT_EQ(seen, (std::vector<int>{0, 1}));
  ASSERT_TRUE(evaluation.rows[2].found);
  EXPECT_GT(evaluation.rows[2].camera_T_model.translation().z(), 0.825) << "the truth is at 0.8";
}

TEST_F(Evaluate, TheReportIsWritten) {
  const Evaluation evaluation = run_evaluation(rendered->set, models, {});
  const Scores scores = score_results(rendered->set, make_pose_errors(rendered->set), evaluation.rows);
  const std::filesystem::path folder = rendered->folder / "report";
  const std::string warning =
      write_report({rendered->set, false, facts_of(models), evaluation, scores, 0, "edgepose eval"}, folder);
  EXPECT_TRUE(std::filesystem::exists(folder / "report.md"));
  EXPECT_EQ(warning.empty(), gnuplot_available());
  if (warning.empty()) {
    for (const char* name : {"recall_by_object", "recall_by_threshold", "recall_by_visibility",
                             "error_histogram", "time_histogram", "time_distribution", "stages"})
      EXPECT_TRUE(std::filesystem::exists(folder / (std::string(name) + ".png"))) << name;
  }
}

TEST_F(Evaluate, BadInputIsNamed) {
  EvalOptions unsound;
  unsound.match.max_instances = 0;
  EXPECT_THROW(run_evaluation(rendered->set, models, unsound), InputError);
  EXPECT_THROW(train_models(rendered->set, unsound), InputError);
  EvalOptions threads;
  threads.threads = -1;
  EXPECT_THROW(run_evaluation(rendered->set, models, threads), InputError);

  TestSet set = rendered->set;
  set.images.resize(1);
  set.images[0].camera.fx = -1;
  try {
    run_evaluation(set, models, {});
    FAIL() << "a camera with negative focal length was taken";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("000000.png"), std::string::npos) << error.what();
  }
  set.images[0].depth = set.objects[0].mesh;  // no PNG
  EXPECT_THROW(run_evaluation(set, models, {}), InputError);
  set.images[0].depth = "/no/such/file.png";
  EXPECT_THROW(run_evaluation(set, models, {}), InputError);

  set.objects[0].mesh = set.objects[0].mesh.parent_path() / "empty.ply";
  std::ofstream(set.objects[0].mesh).flush();
  EXPECT_THROW(train_models(set, {}), InputError);
  EXPECT_THROW(make_pose_errors(set), InputError);
}

TEST(Resources, Grow) {
  EXPECT_GT(peak_memory_megabytes(), 1);
  const double before = process_cpu_seconds();
  volatile double sink = 0;
  while (process_cpu_seconds() == before) sink = sink + 1;
  EXPECT_GT(process_cpu_seconds(), before);
}

}  // namespace
}  // namespace edgepose
