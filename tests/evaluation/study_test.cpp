#include "evaluation/study.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/evaluation/rendered_set.h"
#include "tests/evaluation/tiny_set.h"

namespace edgepose {
namespace {

TEST(Study, EveryExperimentHasSoundVariants) {
  for (const std::string& name : experiment_names())
    for (const Experiment& experiment : experiments(name, {})) {
      EXPECT_GE(experiment.variants.size(), 3u) << experiment.key;
      for (const Variant& variant : experiment.variants)
        EXPECT_EQ(variant.options.check(), "") << experiment.key << " " << variant.method << variant.setting;
    }
  EXPECT_THROW(experiments("colour", {}), InputError);
}

TEST(Study, NoiseDiffersBetweenImagesButNotBetweenMethods) {
  const Experiment noise = experiments("noise", {}).at(0);
  ASSERT_EQ(noise.variants.size(), 10u);
  EXPECT_FALSE(noise.variants[0].options.disturb) << "0 mm: the images as they are";
  DepthImage flat{64, 64, std::vector<float>(64 * 64, 1.0f)};
  const Camera camera{500, 500, 31.5, 31.5};
  TestImage first, second;
  second.image_id = 1;
  const auto noisy = [&](size_t variant, const TestImage& image) {
    return noise.variants[variant].options.disturb(image, flat, camera).depth;
  };
  EXPECT_EQ(noisy(4, first), noisy(9, first)) << "2 mm for both methods";
  EXPECT_NE(noisy(4, first), noisy(4, second));
  double squares = 0;
  for (float z : noisy(4, first)) squares += (z - 1.0) * (z - 1.0);
  EXPECT_NEAR(std::sqrt(squares / (64 * 64)), 0.002, 0.0002);
}

VariantResult result_with(std::vector<EvalRow> rows) {
  VariantResult result;
  result.scores = score_results(tiny_set(), tiny_errors(), rows);
  result.seconds = 0.0125;
  result.verification_seconds = 0.004;
  return result;
}

TEST(Study, TablesHaveThePapersRowsAndColumns) {
  for (const std::string& name : experiment_names())
    for (const Experiment& experiment : experiments(name, {})) {
      const std::vector<VariantResult> results(experiment.variants.size(),
                                               result_with({answer(0, 1, 0.003)}));
      const StudySection section = describe(tiny_set(), experiment, results, 0);
      EXPECT_NE(section.markdown.find("33.33"), std::string::npos) << "pooled: 1 of 3\n" << section.markdown;
      EXPECT_FALSE(section.plots.empty());
    }
}

TEST(Study, AblationColumnsAreObjectsOrGroups) {
  const Experiment experiment = experiments("verification", {}).at(0);
  const std::vector<VariantResult> results = {result_with({}), result_with({answer(0, 1, 0.003)}),
                                              result_with({answer(0, 1, 0.003), answer(1, 1, 0.003)})};
  const std::string by_object = describe(tiny_set(), experiment, results, 0).markdown;
  EXPECT_NE(by_object.find("RR plain"), std::string::npos) << by_object;
  const std::string by_group = describe(tiny_set(), experiment, results, 3).markdown;
  EXPECT_NE(by_group.find("RR S3"), std::string::npos) << by_group;
  EXPECT_NE(by_group.find("| 100.00 |"), std::string::npos) << "S2 of the last\n" << by_group;
}

TEST(Study, RunsEveryVariantAndTrainsAgainWhereNeeded) {
  RenderedSet rendered;
  rendered.set.images.erase(rendered.set.images.begin());
  rendered.set.objects.pop_back();
  Experiment experiment{.key = "test",
                        .title = "Test",
                        .note = "",
                        .setting_label = "step",
                        .layout = Experiment::Layout::kSweep,
                        .variants = {}};
  for (double step : {0.05, 0.08}) {
    Variant variant{"", std::to_string(step), step, {}};
    variant.options.train.distance_step = static_cast<float>(step);
    experiment.variants.push_back(variant);
  }
  double last = 0;
  const auto results =
      run_experiment(rendered.set, make_pose_errors(rendered.set), experiment, [&](double share) {
        EXPECT_GE(share, last);
        last = share;
      });
  EXPECT_EQ(last, 1);
  ASSERT_EQ(results.size(), 2u);
  for (const VariantResult& result : results) {
    EXPECT_EQ(result.scores.pooled.instances, 1u);
    EXPECT_GT(result.seconds, 0);
  }
}

}  // namespace
}  // namespace edgepose
