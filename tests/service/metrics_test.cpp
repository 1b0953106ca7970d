#include "server/metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <sstream>

#include "server/memory_use.h"
#include "tests/service/daemon.h"

namespace edgepose {
namespace {

TEST(Metrics, AreWhatPrometheusReads) {
  const test::Folder folder;
  const Registry registry(folder / "");
  Statistics statistics;
  statistics.counters.add("frames_refused_too_old", 3);
  statistics.counters.add("frames_refused_malformed");
  statistics.counters.add("frames_answered", 7);
  for (int i = 1; i <= 100; ++i) statistics.latency.add(0.001 * i);
  const std::string text = metrics_text(statistics, registry);
  EXPECT_THAT(text, testing::HasSubstr("edgepose_frames_refused_total{cause=\"too_old\"} 3\n"));
  EXPECT_THAT(text, testing::HasSubstr("edgepose_frames_answered_total 7\n"));
  EXPECT_THAT(text, testing::HasSubstr("edgepose_stage_seconds_bucket{stage=\"latency\",le=\"0.05\"} 50\n"));
  EXPECT_THAT(text, testing::HasSubstr("edgepose_stage_seconds_count{stage=\"latency\"} 100\n"));
  // Each line is a comment or a sample; each metric's type is told once, before its first sample.
  std::set<std::string> told;
  std::istringstream lines(text);
  const std::regex sample(
      R"re((edgepose_[a-z_]+?)(_bucket|_sum|_count)?(\{[a-z]+="[a-z_]+"(,le="[0-9.+Inf]+")?\})? [0-9.e+-]+)re");
  for (std::string line; std::getline(lines, line);) {
    std::smatch parts;
    if (line.starts_with("# TYPE ")) {
      EXPECT_TRUE(told.insert(line.substr(7, line.rfind(' ') - 7)).second) << line;
    }
    if (line.starts_with("#")) continue;
    ASSERT_TRUE(std::regex_match(line, parts, sample)) << line;
    EXPECT_TRUE(told.contains(parts[1])) << line;
  }
}

TEST(Recent, QuantilesOfTheLastThousand) {
  Recent recent;
  EXPECT_EQ(recent.quantile(0.5), 0);
  for (int i = 0; i < 5000; ++i) recent.add(i < 4000 ? 100.0 : 0.001 * (i - 4000));
  EXPECT_NEAR(recent.quantile(0.5), 0.5, 0.01);
  EXPECT_NEAR(recent.quantile(1), 0.999, 1e-9);
  EXPECT_EQ(recent.histogram().count, 5000u);
}

TEST(MemoryUse, IsTold) {
  EXPECT_GT(memory_use().resident_bytes, 1'000'000u);
  EXPECT_GE(memory_use().threads, 1);
  EXPECT_GT(memory_use().open_files, 2u);
}

}  // namespace
}  // namespace edgepose
