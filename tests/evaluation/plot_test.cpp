#include "evaluation/plot.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "common/error.h"
#include "evaluation/report.h"

namespace edgepose {
namespace {

class PlotTest : public ::testing::Test {
 protected:
  PlotTest()
      : folder(std::filesystem::temp_directory_path() / ("edgepose_plot_" + std::to_string(getpid()))) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
  }
  ~PlotTest() override { std::filesystem::remove_all(folder); }

  static std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

  void draw_now(const Plot& plot) const {
    FileGroup files;
    draw(plot, folder, files);
    files.commit();
  }

  std::filesystem::path folder;
};

Plot bars() {
  return {.kind = Plot::Kind::kBars,
          .file = "bars",
          .title = "Bars",
          .x_label = "x",
          .y_label = "y",
          .labels = {"a", "b"},
          .series = {{"first", {}, {1, 2}}, {"second", {}, {2, 1}}}};
}

TEST_F(PlotTest, DrawsEveryKind) {
  if (!gnuplot_available()) GTEST_SKIP() << "SKIPPED, program missing: gnuplot (install gnuplot-nox)";
  for (auto kind : {Plot::Kind::kBars, Plot::Kind::kStackedBars}) {
    Plot plot = bars();
    plot.kind = kind;
    draw_now(plot);
    EXPECT_EQ(content(folder / "bars.png").substr(1, 3), "PNG");
  }
  for (auto kind : {Plot::Kind::kLines, Plot::Kind::kSteps, Plot::Kind::kPoints, Plot::Kind::kHistogram}) {
    Plot plot{.kind = kind,
              .file = "curve",
              .title = "Curve",
              .x_label = "x",
              .y_label = "y",
              .series = {{"first", {1, 2, 3}, {3, 1, 2}}},
              .log_x = true};
    draw_now(plot);
    EXPECT_GT(std::filesystem::file_size(folder / "curve.png"), 1000u);
  }
}

TEST_F(PlotTest, NamesFromFilesAreNotRun) {
  if (!gnuplot_available()) GTEST_SKIP() << "SKIPPED, program missing: gnuplot (install gnuplot-nox)";
  const std::filesystem::path trap = folder / "trap";
  Plot plot = bars();
  plot.labels = {"`touch " + trap.string() + "`", "\"; system(\"touch " + trap.string() + "\"); \""};
  plot.title = "'; system('touch " + trap.string() + "'); '";
  plot.series[0].name = "$(touch " + trap.string() + ")\nEND\n!touch " + trap.string();
  draw_now(plot);
  EXPECT_FALSE(std::filesystem::exists(trap));
}

TEST_F(PlotTest, PanelsOfAFigureStandInOnePicture) {
  if (!gnuplot_available()) GTEST_SKIP() << "no gnuplot";
  Plot path{.file = "", .title = "path", .x_label = "mm", .y_label = "mm", .y_any = true, .to_scale = true};
  path.series = {{"path", {0, 10, 30}, {-5, 0, 5}}, {.name = "end", .x = {30}, .y = {5}, .marks = true}};
  Plot error{.file = "", .title = "error", .x_label = "s", .y_label = "mm", .log_y = true};
  error.series = {{"", {0, 1, 2}, {100, 1, 0.01}}};
  FileGroup files;
  draw(Figure{.file = "both", .title = "Both", .panels = {path, error}, .columns = 2}, folder, files);
  files.commit();
  EXPECT_TRUE(content(folder / "both.png").starts_with("\x89PNG"));
  const std::string script = content(folder / "both.gp");
  EXPECT_NE(script.find("multiplot layout 1,2"), std::string::npos);
  // 30 wide, 10 high: both axes 33 long.
  EXPECT_NE(script.find("set xrange [-1.5:31.5]\nset yrange [-16.5:16.5]"), std::string::npos) << script;
}

TEST_F(PlotTest, WithoutGnuplotThereIsAWarningAndNoPlot) {
  const char* path = std::getenv("PATH");
  const std::string kept = path ? path : "";
  setenv("PATH", folder.c_str(), 1);
  std::string warning;
  std::string markdown;
  FileGroup files;
  EXPECT_NO_THROW(markdown = draw_all({bars()}, folder, files, warning));
  EXPECT_THROW(draw_now(bars()), InputError);
  setenv("PATH", kept.c_str(), 1);
  EXPECT_NE(warning.find("gnuplot"), std::string::npos);
  EXPECT_EQ(warning.find('\n'), std::string::npos);
  EXPECT_NE(markdown.find("gnuplot"), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(folder / "bars.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "bars.gp")) << "a script whose plot failed";
}

TEST_F(PlotTest, RefusesAFolderThatIsAFile) {
  std::ofstream(folder / "file") << "x";
  std::string warning;
  FileGroup files;
  EXPECT_THROW(draw_all({}, folder / "file", files, warning), InputError);
  EXPECT_THROW(draw_all({}, folder / "file" / "below", files, warning), InputError);
}

TEST(HarmlessText, KeepsNamesAndDropsSyntax) {
  EXPECT_EQ(harmless_text("parasaurolophus-2 (left).ply"), "parasaurolophus-2 (left).ply");
  EXPECT_EQ(harmless_text("a|b`c\"d'e\nf$g\\h@"), "a?b?c?d?e?f?g?h?");
}

}  // namespace
}  // namespace edgepose
