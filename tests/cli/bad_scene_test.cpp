/// Depth images, cameras, clouds and plans that must be refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

std::string png(const Folder& folder, const std::string& name, const cv::Mat& image) {
  cv::imwrite(folder / name, image);
  return folder / name;
}

Finished match_depth(const std::string& depth, const std::string& camera = "504,504,319.5,287.5") {
  return edgepose({"match", phantom_model(), "--depth", depth, "--intrinsics", camera});
}

TEST(BadScene, DepthImageThatIsNone) {
  const Folder folder;
  expect_refused(match_depth(png(folder, "8bit.png", cv::Mat(480, 640, CV_8UC1, 100))),
                 {"8bit.png", "16", "8"});
  expect_refused(match_depth(png(folder, "colour.png", cv::Mat(480, 640, CV_16UC3, cv::Scalar(1, 2, 3)))),
                 {"colour.png"});
  expect_refused(match_depth(png(folder, "zero.png", cv::Mat::zeros(480, 640, CV_16UC1))), {"zero.png"});
  expect_refused(match_depth(folder.write("empty.png", "")), {"empty.png", "empty"});
  expect_refused(match_depth(folder.write("text.png", "no picture")), {"text.png", "PNG"});
  expect_refused(match_depth(folder / "missing.png"), {"missing.png"});
  const std::string sound = read_file(phantom_file("scene/depth.png"));
  ASSERT_GT(sound.size(), 1000u);
  expect_refused(match_depth(folder.write("cut.png", sound.substr(0, sound.size() / 2))), {"cut.png"});
  std::string flipped = sound;
  flipped[flipped.size() / 2] = static_cast<char>(flipped[flipped.size() / 2] ^ 4);
  expect_refused(match_depth(folder.write("flipped.png", flipped)), {"flipped.png"});
}

TEST(BadScene, DepthThatCannotBeMatchedIsNamedWithItsRange) {
  const Folder folder;
  const std::string far = png(folder, "far.png", cv::Mat(480, 640, CV_16UC1, 30000));
  expect_refused(match_depth(far), {"far.png", "0.05 to 10 m", "30 to 30 m", "--depth-scale"});
  expect_refused(match_depth(png(folder, "near.png", cv::Mat(480, 640, CV_16UC1, 7))),
                 {"near.png", "0.007 to 0.007 m", "--depth-scale"});
  const auto tiny = png(folder, "tiny.png", cv::Mat(1, 1, CV_16UC1, 500));
  expect_refused(match_depth(tiny, "1,1,0,0"), {"tiny.png", "1 x 1"});
  for (const char* scale : {"nan", "inf", "1e308", "0", "one"}) {
    const Finished run = edgepose({"match", phantom_model(), "--depth", far, "--intrinsics",
                                   "504,504,319.5,287.5", "--depth-scale", scale});
    expect_refused(run, {"--depth-scale", "0.0001 to 100", scale});
    EXPECT_LT(run.err.size(), 200u) << run.err;
  }
}

TEST(BadScene, WarningsNameTheFileOnce) {
  const Folder folder;
  const std::string yaml = folder.write(
      "w.yaml",
      "height: 576\nwidth: 640\nD: [0.1, 0, 0, 0, 0]\nK: [504, 0, 319.5, 0, 504, 287.5, 0, 0, 1]\n");
  const Finished run = match_depth(phantom_file("scene/depth.png"), yaml);
  EXPECT_THAT(run.err, testing::HasSubstr("w.yaml: warning: lens distortion"));
  EXPECT_EQ(run.err.find("lens distortion"), run.err.rfind("lens distortion")) << run.err;
  const Finished cut = match_depth(phantom_file("scene/depth.png"), "504,504,-20,287.5");
  EXPECT_THAT(cut.err, testing::HasSubstr("warning: the principal point (-20, 287.5)"));
  EXPECT_EQ(cut.err.find("principal point"), cut.err.rfind("principal point")) << cut.err;
}

TEST(BadScene, CameraThatIsNone) {
  const std::string depth = phantom_file("scene/depth.png");
  const Folder folder;
  expect_refused(edgepose({"match", phantom_model(), "--depth", depth}), {"--intrinsics"});
  expect_refused(match_depth(depth, "-504,504,319.5,287.5"), {"-504"});
  expect_refused(match_depth(depth, "0,504,319.5,287.5"), {"0"});
  expect_refused(match_depth(depth, "504,504,319.5"), {"fx,fy,cx,cy"});
  expect_refused(match_depth(depth, "nan,504,319.5,287.5"), {"nan"});
  expect_refused(match_depth(depth, "504,504,7000,287.5"), {"7000", "640 x 576"});
  for (const char* fx : {"1e-30", "0.001", "50", "1e5"})
    expect_refused(match_depth(depth, std::string(fx) + ",504,319.5,287.5"), {fx, "fx"});
  expect_refused(match_depth(depth, folder / "no.json"), {"no.json"});
  expect_refused(match_depth(depth, folder.write("half.json", "{\"0\": {\"cam_K\": [1, 2")), {"half.json"});
  expect_refused(
      match_depth(depth, folder.write("short.json", "{\"0\": {\"cam_K\": [1, 2], \"depth_scale\": 1}}")),
      {"short.json"});
  expect_refused(match_depth(depth, folder.write("info.yaml", "camera_matrix: [")), {"info.yaml"});
}

TEST(BadScene, CloudThatIsNone) {
  const Folder folder;
  const auto match_cloud = [](const std::string& cloud) {
    return edgepose({"match", phantom_model(), "--cloud", cloud});
  };
  expect_refused(match_cloud(folder / "no.ply"), {"no.ply"});
  expect_refused(match_cloud(folder.write("empty.pcd", "")), {"empty.pcd"});
  expect_refused(match_cloud(folder.write("few.ply", bracket_ply(100))), {"few.ply", "100"});
}

TEST(BadScene, PlanThatDoesNotFit) {
  const Folder folder;
  const auto match_plan = [](const std::string& plan) {
    return edgepose({"match", phantom_model(), "--depth", phantom_file("scene/depth.png"), "--intrinsics",
                     phantom_file("scene/camera.json"), "--plan", plan});
  };
  expect_refused(match_plan(folder / "no.json"), {"no.json"});
  expect_refused(match_plan(folder.write("empty.json", "{}")), {"empty.json"});
  std::string other = read_file(phantom_file("drill_plan.json"));
  const size_t at = other.find("\"model_diameter_mm\": ");
  ASSERT_NE(at, std::string::npos);
  other.insert(at + 21, "1");  // a hundred millimetres more
  expect_refused(match_plan(folder.write("other.json", other)), {"other.json", "diameter"});
}

}  // namespace
}  // namespace edgepose::test
