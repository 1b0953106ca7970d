/// --deadline-ms of `edgepose match` and `edgepose eval`.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

using nlohmann::json;

/// No candidate is ever sure or settled enough, so only the deadline can end the search early.
constexpr const char* kNeverSure =
    "[match.search]\nsure_once = 1.1\nsure_twice = 1.1\nsure_thrice = 1.1\nsettled = 100000\n";

std::vector<std::string> with_sample(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"match",        phantom_model(),
                                        "--depth",      phantom_file("scene/depth.png"),
                                        "--intrinsics", phantom_file("scene/camera.json")};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

json answer(const std::vector<std::string>& more) {
  std::vector<std::string> arguments = more;
  arguments.emplace_back("--json");
  const Finished run = edgepose(with_sample(arguments));
  EXPECT_LE(run.code, 1) << run.err;
  const json report = json::parse(run.out, nullptr, false);
  EXPECT_FALSE(report.is_discarded()) << run.err;
  return report.at("models").at(0);
}

TEST(Deadline, MustBeANumberAboveZero) {
  for (const char* wrong : {"0", "-5", "nan", "inf", "soon", "1e9", ""}) {
    expect_refused(edgepose(with_sample({"--deadline-ms", wrong})), {"--deadline-ms", "above 0"});
    expect_refused(edgepose({"eval", "no_set", "--deadline-ms", wrong}), {"--deadline-ms", "above 0"});
  }
}

TEST(Deadline, EndsTheSearchAndTheAnswerSaysSo) {
  const Folder folder;
  const std::string config = folder.write("c.toml", kNeverSure);
  EXPECT_EQ(answer({"--config", config}).at("cut_short"), false);
  const json hurried = answer({"--config", config, "--deadline-ms", "0.001"});
  EXPECT_EQ(hurried.at("cut_short"), true);
  const Finished table = edgepose(with_sample({"--config", config, "--deadline-ms", "0.001"}));
  EXPECT_THAT(table.out, testing::HasSubstr("cut short"));
}

TEST(Deadline, LongEnoughItChangesNothing) {
  const json calm = answer({}), limited = answer({"--deadline-ms", "60000"});
  EXPECT_EQ(limited.at("cut_short"), false);
  EXPECT_EQ(limited.at("detections"), calm.at("detections"));
}

TEST(Deadline, TakesThePlaceOfMaxSeconds) {
  const Folder folder;
  const std::string config =
      folder.write("c.toml", std::string("[match]\nmax_seconds = 1e-6\n") + kNeverSure);
  EXPECT_EQ(answer({"--config", config}).at("cut_short"), true);
  EXPECT_EQ(answer({"--config", config, "--deadline-ms", "60000"}).at("cut_short"), false);
}

TEST(Deadline, EvalCountsTheSearchesThatItEnded) {
  const Folder folder;
  const std::string config = folder.write("c.toml", kNeverSure);
  const std::string set = EDGEPOSE_SOURCE_DIR "/models/sample_set";
  const auto eval = [&](const std::string& milliseconds) {
    const Finished run =
        edgepose({"eval", set, "--images", "0-1", "--config", config, "--deadline-ms", milliseconds});
    EXPECT_EQ(run.code, 0) << run.err;
    return run.out;
  };
  EXPECT_THAT(eval("0.001"), testing::ContainsRegex("ended by the deadline +\\| +2 of 2"));
  EXPECT_THAT(eval("60000"), testing::Not(testing::HasSubstr("ended by the deadline")));
}

}  // namespace
}  // namespace edgepose::test
