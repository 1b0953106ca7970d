/// Agreement with the independent scoring program that lies beside the test sets (tools/score.py), on answers
/// made from the ground truth: some right, some slightly or badly wrong, some missing, some for absent
/// objects.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>

#include "evaluation/score.h"
#include "tests/shared_data.h"

namespace edgepose {
namespace {

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string text;
  char buffer[4096];
  while (size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
  pclose(pipe);
  return text;
}

/// The truth, moved at random by up to an eighth of the diameter.
RigidTransform moved(const GroundTruth& truth, double diameter, std::mt19937& random) {
  std::uniform_real_distribution<double> unit(-1, 1), size(0, 1);
  const double share = std::pow(size(random), 2);
  const Eigen::Vector3d axis(unit(random), unit(random), unit(random)),
      shift(unit(random), unit(random), unit(random));
  RigidTransform change(Eigen::AngleAxisd(0.3 * share, axis.normalized()));
  RigidTransform pose = truth.camera_T_model * change;
  pose.translation() += 0.1 * diameter * share * shift;
  return pose;
}

std::vector<BopResult> disturbed_truth(const TestSet& set, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<BopResult> results;
  for (const TestImage& image : set.images) {
    for (const TestObject& object : set.objects) {
      const GroundTruth* present = nullptr;
      for (const GroundTruth& truth : image.truth)
        if (truth.object_id == object.id) present = &truth;
      if (random() % 10 == 0 || (!present && random() % 4 != 0)) continue;  // no answer
      BopResult result;
      result.scene_id = image.scene_id;
      result.image_id = image.image_id;
      result.object_id = object.id;
      result.score = 0.01 * static_cast<double>(random() % 100);
      result.time = 0.001 * static_cast<double>(1 + random() % 500);
      if (present) result.camera_T_model = moved(*present, object.diameter, random);
      results.push_back(result);
      if (random() % 5 == 0) {  // a worse second answer that must not count
        result.score -= 0.5;
        result.camera_T_model.translation() += Eigen::Vector3d(0, 0, 1);
        results.push_back(result);
      }
    }
  }
  return results;
}

class ReferenceScore : public ::testing::TestWithParam<std::string> {};

TEST_P(ReferenceScore, Agrees) {
  EDGEPOSE_NEEDS_SHARED(GetParam());
  const std::filesystem::path program = shared_data("..") / "tools" / "score.py";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "SKIPPED, program missing: " << program;
  if (std::system("/usr/bin/python3 -c 'import numpy, scipy.spatial' 2>/dev/null") != 0)
    GTEST_SKIP() << "SKIPPED, /usr/bin/python3 with numpy and scipy is missing (python3-numpy python3-scipy)";

  const TestSet set = read_test_set(shared_data(GetParam()));
  const std::filesystem::path csv =
      std::filesystem::temp_directory_path() / ("edgepose_reference_" + std::to_string(getpid()) + ".csv");
  write_bop_results(csv, disturbed_truth(set, 7));
  const Scores scores = score_results(set, make_pose_errors(set), from_bop_results(read_bop_results(csv)));
  const std::string text = output_of("/usr/bin/python3 '" + program.string() + "' '" +
                                     shared_data(GetParam()).string() + "' '" + csv.string() + "'");
  std::filesystem::remove(csv);

  for (size_t k = 0; k < kThresholds.size(); ++k) {
    // The two draw other vertices: instances this close to the threshold may fall on either side of it.
    size_t close = 0;
    for (const InstanceScore& i : scores.instances)
      close += std::abs(i.error / (kThresholds[k] * i.diameter) - 1) < (i.symmetric ? 0.1 : 0.03);
    EXPECT_LE(close, scores.instances.size() / 8) << "too many to say anything";
    std::smatch figures;
    char label[16];
    std::snprintf(label, sizeof label, "%gd", kThresholds[k]);
    ASSERT_TRUE(
        std::regex_search(text, figures, std::regex(std::string(label) + " MR ([0-9.]+) pooled ([0-9.]+)")))
        << text;
    const double count = static_cast<double>(scores.pooled.instances);
    const double theirs = std::stod(figures[2]) * count / 100,
                 ours = static_cast<double>(scores.pooled.correct[k]);
    EXPECT_NEAR(ours, theirs, static_cast<double>(close) + 0.01) << label;
    if (close == 0) {
      EXPECT_NEAR(100 * scores.mean_recall[k], std::stod(figures[1]), 0.06) << label;  // they round RR to 0.1
    }
    EXPECT_GT(ours, 0);
    EXPECT_LT(ours, count);
  }
  std::smatch counts;
  ASSERT_TRUE(std::regex_search(
      text, counts, std::regex("n ([0-9]+) answered ([0-9]+) false-positives ([0-9]+) of ([0-9]+) absent")))
      << text;
  EXPECT_EQ(scores.pooled.instances, std::stoul(counts[1]));
  EXPECT_EQ(scores.false_positives, std::stoul(counts[3]));
  EXPECT_EQ(scores.absent_pairs, std::stoul(counts[4]));
  std::smatch times;
  ASSERT_TRUE(
      std::regex_search(text, times, std::regex("time median ([0-9.]+) s mean ([0-9.]+) p95 ([0-9.]+)")));
  EXPECT_NEAR(scores.time.median, std::stod(times[1]), 0.0006);
  EXPECT_NEAR(scores.time.mean, std::stod(times[2]), 0.0006);
  EXPECT_NEAR(scores.time.p95, std::stod(times[3]), 0.0006);
}

INSTANTIATE_TEST_SUITE_P(Sets, ReferenceScore,
                         ::testing::Values("range", "spine", "industrial", "real_dragon", "real_bunny"),
                         [](const auto& parameter) { return parameter.param; });

}  // namespace
}  // namespace edgepose
