/// The main job on the project's own sample, through the program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "files/bop_json.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "files/mesh_file.h"
#include "tests/cli/program.h"

namespace edgepose::test {
namespace {

using nlohmann::json;

std::vector<std::string> match_sample(std::vector<std::string> more) {
  std::vector<std::string> arguments = {"match", phantom_model()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::vector<std::string> with_depth(std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"--depth", phantom_file("scene/depth.png"), "--intrinsics",
                             phantom_file("scene/camera.json")});
  return match_sample(more);
}

RigidTransform transform(const json& rows) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) matrix(row, column) = rows[row][column].get<double>();
  }
  return RigidTransform(matrix);
}

RigidTransform true_pose() {
  const std::string file = phantom_file("scene/truth.json");
  return parse_bop_truth(read_file(file), file).at(0).at(0).camera_T_model;
}

void expect_near(const RigidTransform& found, const RigidTransform& truth) {
  EXPECT_LT((found.translation() - truth.translation()).norm(), 1.5e-3);
  EXPECT_LT(Eigen::AngleAxisd(found.linear().transpose() * truth.linear()).angle(), 0.03);
}

TEST(Sample, PaperModeAnswersWithAPoseAndItsEdgeScore) {
  const Finished run = edgepose(with_depth({"--paper-mode", "--json"}));
  ASSERT_EQ(run.code, 0) << run.err;
  const json detections = json::parse(run.out).at("models").at(0).at("detections");
  ASSERT_EQ(detections.size(), 1u);
  EXPECT_GT(detections.at(0).at("edge_score").get<double>(), 0.1);
}

TEST(Sample, JsonHoldsTheTruePoseAndAllThatTheIssueAsksFor) {
  const Finished run = edgepose(with_depth({"--json", "--plan", phantom_file("drill_plan.json")}));
  ASSERT_EQ(run.code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report.at("frame"), "camera");
  const json& model = report.at("models").at(0);
  EXPECT_EQ(model.at("found"), true);
  EXPECT_EQ(model.at("reason"), "");
  const json& best = model.at("detections").at(0);
  const RigidTransform found = transform(best.at("camera_T_model"));
  expect_near(found, true_pose());
  const json& q = best.at("quaternion_wxyz");
  const Eigen::Quaterniond turn(q[0].get<double>(), q[1].get<double>(), q[2].get<double>(),
                                q[3].get<double>());
  EXPECT_LT((turn.toRotationMatrix() - found.linear()).norm(), 1e-6);
  EXPECT_LT((found.linear().transpose() * found.linear() - Eigen::Matrix3d::Identity()).norm(), 1e-6);
  for (const char* key : {"score", "edge_score", "coverage", "violations", "margin"}) {
    EXPECT_TRUE(best.at(key).is_number()) << key;
  }
  ASSERT_EQ(best.at("covariance").size(), 6u);
  EXPECT_EQ(best.at("covariance").at(5).size(), 6u);
  EXPECT_GT(model.at("seconds").at("total").get<double>(), 0);

  ASSERT_EQ(report.at("plan").size(), 3u);
  const json& target = report.at("plan").at(0);
  EXPECT_EQ(target.at("name"), "left_pedicle_screw");
  const json& entry = target.at("entry_m");
  const Eigen::Vector3d expected =
      true_pose() * Eigen::Vector3d(18.513488456681774e-3, 37.314637980481024e-3, 4.8e-3);
  const Eigen::Vector3d placed(entry[0].get<double>(), entry[1].get<double>(), entry[2].get<double>());
  EXPECT_LT((placed - expected).norm(), 1.5e-3);
}

TEST(Sample, TableAndOverlay) {
  const Folder folder;
  const Finished run = edgepose(with_depth({"--overlay", folder / "found.png"}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr("vertebra_phantom"));
  EXPECT_THAT(run.out, testing::HasSubstr("yes"));
  const cv::Mat samples = cv::imread(folder / "found.png");
  ASSERT_FALSE(samples.empty());
  ASSERT_EQ(
      edgepose(with_depth({"--overlay", folder / "mesh.png", "--mesh", phantom_file("phantom.ply")})).code,
      0);
  EXPECT_EQ(samples.cols, 2 * 640);  // the whole image
  EXPECT_FALSE(cv::imread(folder / "mesh.png").empty());
  EXPECT_THAT(folder.files(), testing::ElementsAre("found.png", "mesh.png"));
}

/// Pixels of the colour that holes are drawn in.
int target_pixels(const std::string& picture) {
  cv::Mat mask;
  cv::inRange(cv::imread(picture), cv::Scalar(40, 222, 255), cv::Scalar(40, 222, 255), mask);
  return cv::countNonZero(mask);
}

TEST(Sample, TheOverlayShowsThePlansHolesWithAndWithoutAMesh) {
  const Folder folder;
  const std::string plan = phantom_file("drill_plan.json");
  ASSERT_EQ(edgepose(with_depth({"--overlay", folder / "none.png"})).code, 0);
  ASSERT_EQ(edgepose(with_depth({"--plan", plan, "--overlay", folder / "samples.png"})).code, 0);
  ASSERT_EQ(edgepose(with_depth({"--plan", plan, "--overlay", folder / "mesh.png", "--mesh",
                                 phantom_file("phantom.ply")}))
                .code,
            0);
  EXPECT_EQ(target_pixels(folder / "none.png"), 0);
  EXPECT_GT(target_pixels(folder / "mesh.png"), 100);
  EXPECT_GT(target_pixels(folder / "samples.png"), 100);
}

TEST(Sample, TheResultDoesNotDependOnTheThreads) {
  const auto poses = [](const std::string& threads) {
    const json report = json::parse(edgepose(with_depth({"--json", "--threads", threads})).out);
    return report.at("models").at(0).at("detections").dump();
  };
  const std::string one = poses("1");
  EXPECT_EQ(one, poses("2"));
  EXPECT_EQ(one, poses("3"));
}

TEST(Sample, ACloudIsAnsweredInItsOwnFrame) {
  // The depth image as a cloud, moved to where only the right frame gives the right answer.
  const CameraFile file = read_camera(phantom_file("scene/camera.json"));
  const DepthImage depth = read_depth_png(phantom_file("scene/depth.png"), file.depth_scale);
  RigidTransform cloud_T_camera = RigidTransform::Identity();
  cloud_T_camera.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 3).normalized()));
  cloud_T_camera.pretranslate(Eigen::Vector3d(0.5, -0.2, 0.1));
  Mesh cloud;
  for (int v = 0; v < depth.height; ++v) {
    for (int u = 0; u < depth.width; ++u) {
      const double z = static_cast<double>(depth.at(u, v));
      if (z <= 0) continue;
      const Eigen::Vector3d point((u - file.camera.cx) / file.camera.fx * z,
                                  (v - file.camera.cy) / file.camera.fy * z, z);
      cloud.vertices.emplace_back((cloud_T_camera * point).cast<float>());
    }
  }
  const Folder folder;
  write_ply(folder / "cloud.ply", cloud, LengthUnit::kMetre);
  const Finished run = edgepose(match_sample(
      {"--cloud", folder / "cloud.ply", "--unit", "m", "--viewpoint", "0.5,-0.2,0.1", "--json"}));
  ASSERT_EQ(run.code, 0) << run.err << run.out;
  const json report = json::parse(run.out);
  EXPECT_EQ(report.at("frame"), "cloud");
  expect_near(transform(report.at("models").at(0).at("detections").at(0).at("cloud_T_model")),
              cloud_T_camera * true_pose());
}

TEST(Sample, AnAbsentObjectIsNotFoundAndTheReasonIsGiven) {
  const Folder folder;
  const std::string model = folder / "bracket.model";
  ASSERT_EQ(edgepose({"train", folder.write("bracket.ply", bracket_ply(150)), "-o", model}).code, 0);
  const Finished run = edgepose({"match", model, "--depth", phantom_file("scene/depth.png"), "--intrinsics",
                                 phantom_file("scene/camera.json"), "--json"});
  EXPECT_EQ(run.code, 1) << run.out;
  const json absent = json::parse(run.out).at("models").at(0);
  EXPECT_EQ(absent.at("found"), false);
  EXPECT_NE(absent.at("reason"), "");
  // Beside one that is there, the answer is "found".
  const Finished both = edgepose({"match", model, phantom_model(), "--depth", phantom_file("scene/depth.png"),
                                  "--intrinsics", phantom_file("scene/camera.json")});
  EXPECT_EQ(both.code, 0);
  EXPECT_THAT(both.out, testing::HasSubstr("not found"));
}

TEST(Sample, TheReasonRoundsAsTheTableDoes) {
  const Finished run =
      edgepose({"match", phantom_model(), "--depth", phantom_file("scene/depth.png"), "--intrinsics",
                phantom_file("scene/camera.json"), "--accept", "0.999", "--json"});
  EXPECT_EQ(run.code, 1) << run.out;
  const json model = json::parse(run.out).at("models").at(0);
  char score[8];
  std::snprintf(score, sizeof score, "%.2f", model.at("detections").at(0).at("score").get<double>());
  EXPECT_THAT(model.at("reason").get<std::string>(),
              testing::HasSubstr("has score " + std::string(score) + " of the 1.00 wanted"));
}

TEST(Sample, InfoDescribesTheModel) {
  const Finished run = edgepose({"info", phantom_model(), "--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report.at("name"), "vertebra_phantom");
  EXPECT_NEAR(report.at("diameter_m").get<double>(), 0.0906, 0.002);
  EXPECT_GT(report.at("points").get<int>(), 100);
  EXPECT_GT(report.at("pairs").get<int>(), 10000);
  EXPECT_EQ(report.at("file_bytes").get<size_t>(), read_file(phantom_model()).size());
  EXPECT_GT(report.at("expected_seconds_640x480").at("total").get<double>(), 0);
  EXPECT_THAT(edgepose({"info", phantom_model()}).out, testing::HasSubstr("expected time"));
}

}  // namespace
}  // namespace edgepose::test
