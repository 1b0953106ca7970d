#include "client/service/depth_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/error.h"
#include "files/depth_file.h"

namespace edgepose {
namespace {

class DepthFiles : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_); }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void image(const std::string& name) const {
    write_depth_png(folder_ / name, {4, 2, {1, 1, 1, 1, 1, 1, 1, 1}}, 0.001);
  }
  std::string fault(const std::filesystem::path& path, const DepthFileOptions& options) const {
    try {
      for (const DepthFile& file : find_depth_files({path}, options)) read_depth_file(file);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  const std::filesystem::path sample_ = std::filesystem::path(EDGEPOSE_SOURCE_DIR) / "models/sample_set";
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("depth_files_" + std::to_string(getpid()));
};

TEST_F(DepthFiles, AFolderByRisingName) {
  image("b.png"), image("a.png"), image("c.png");
  const auto files = find_depth_files({folder_}, {"4,4,2,1", 2});
  ASSERT_EQ(files.size(), 3u);
  EXPECT_EQ(files[0].path.filename(), "a.png");
  EXPECT_EQ(files[2].path.filename(), "c.png");
  EXPECT_DOUBLE_EQ(files[0].depth_scale, 0.002);
  EXPECT_FLOAT_EQ(read_depth_file(files[0]).at(0, 0), 2);
}

TEST_F(DepthFiles, ASceneAndItsSetAreTheSame) {
  const auto scene = find_depth_files({sample_ / "test/000001"}, {});
  const auto set = find_depth_files({sample_}, {});
  ASSERT_EQ(scene.size(), 6u);
  ASSERT_EQ(set.size(), 6u);
  for (size_t i = 0; i < 6; ++i) {
    EXPECT_EQ(scene[i].path, set[i].path);
    EXPECT_EQ(scene[i].camera.fx, set[i].camera.fx);
    EXPECT_EQ(scene[i].depth_scale, set[i].depth_scale);
    EXPECT_GT(read_depth_file(scene[i]).width, 0);
  }
}

TEST_F(DepthFiles, WhatIsMissingIsNamed) {
  EXPECT_THAT(fault(folder_, {}), testing::HasSubstr("none in it"));
  image("a.png");
  EXPECT_THAT(fault(folder_, {}), testing::HasSubstr("--intrinsics"));
  EXPECT_THAT(fault(folder_, {"500,500,2,1", 0}), testing::HasSubstr("a.png")) << "no camera of 4 x 2 pixels";
  EXPECT_THAT(fault(folder_ / "no.png", {"4,4,2,1", 0}), testing::HasSubstr("no.png"));
}

}  // namespace
}  // namespace edgepose
