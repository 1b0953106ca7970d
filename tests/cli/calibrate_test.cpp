// edgepose calibrate hand-eye, edgepose teach: the program itself.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>

#include "arm/rigid_motion.h"
#include "calibration/hand_eye_file.h"
#include "calibration/teach_file.h"
#include "tests/cli/program.h"

namespace edgepose {
namespace {

using nlohmann::json;

struct Poses {
  std::mt19937_64 random{4};
  std::normal_distribution<double> normal;

  Eigen::Vector3d gauss(double sigma) {
    const double x = normal(random), y = normal(random), z = normal(random);
    return sigma * Eigen::Vector3d(x, y, z);
  }
  RigidTransform around(double angle, double distance) {
    const Eigen::Vector3d turn = gauss(angle);
    return rigid_transform(rotation_matrix(turn), gauss(distance));
  }
};

json in_file(const RigidTransform& pose) {
  const Eigen::Vector3d turn = rotation_vector(pose.linear()), place = pose.translation();
  return {{"rotation_vector_rad", {turn[0], turn[1], turn[2]}},
          {"translation_m", {place[0], place[1], place[2]}}};
}

RigidTransform true_camera() {
  return rigid_transform(rotation_matrix(Eigen::Vector3d(0.02, -0.3, 1.5)), {0.08, -0.02, 0.06});
}

std::string samples(int count) {
  Poses poses;
  const RigidTransform over = rigid_transform(rotation_matrix(Eigen::Vector3d(3, 0, 0)), {0.5, 0, 0.4});
  const RigidTransform target = poses.around(0.2, 0.1);
  json file = {{"kind", "hand-eye-samples"}, {"samples", json::array()}};
  for (int i = 0; i < count; ++i) {
    const RigidTransform flange = over * poses.around(0.3, 0.05);
    file["samples"].push_back({{"base_T_flange", in_file(flange)},
                               {"camera_T_target", in_file((flange * true_camera()).inverse() * target)}});
  }
  return file.dump();
}

const RigidTransform kTool = rigid_transform(rotation_matrix(Eigen::Vector3d(0.2, 0, 0)), {0.02, 0, 0.35});

std::string record(int references) {
  Poses poses;
  json file = {{"kind", "teach-record"}, {"model", "phantom"}, {"references", json::array()}};
  for (int i = 0; i < references; ++i) {
    const RigidTransform hole = poses.around(0.3, 0.02);
    json reference = {{"name", "hole " + std::to_string(i + 1)}, {"model_T_tool", in_file(hole)}};
    for (int k = 0; k < 30; ++k)
      reference["camera_T_model"].push_back(in_file(kTool * hole.inverse() * poses.around(0.001, 0.0002)));
    file["references"].push_back(reference);
  }
  return file.dump();
}

TEST(Calibrate, HandEyeIsFoundPrintedAndWritten) {
  const test::Folder folder;
  const std::string in = folder.write("samples.json", samples(12)), out = folder / "hand_eye.json";
  const test::Finished run = test::edgepose({"calibrate", "hand-eye", in, "-o", out});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr("flange_T_camera     80.000   -20.000    60.000 mm"));
  EXPECT_THAT(run.out, testing::HasSubstr("sample 12"));
  const HandEyeFile file = read_hand_eye(out);
  EXPECT_LT((file.flange_T_camera.matrix() - true_camera().matrix()).norm(), 1e-6);
  EXPECT_EQ(file.samples, 12);
}

TEST(Calibrate, TeachLearnsAndSaysHowWell) {
  const test::Folder folder;
  const std::string in = folder.write("record.json", record(5)), out = folder / "taught.json";
  const test::Finished run = test::edgepose({"teach", in, "-o", out});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, testing::HasSubstr("hole 5"));
  const TaughtFile file = read_taught(out);
  EXPECT_EQ(file.model, "phantom");
  EXPECT_LT((file.taught.camera_T_tool.translation() - kTool.translation()).norm(), 0.0003);
}

TEST(Calibrate, BadInputIsRefused) {
  const test::Folder folder;
  const std::string few = folder.write("few.json", samples(4)), out = folder / "out.json";
  test::expect_refused(test::edgepose({"calibrate", "hand-eye", few, "-o", out}),
                       {"few.json", "at least 5 samples"});
  const std::string four = folder.write("four.json", record(4));
  test::expect_refused(test::edgepose({"teach", four, "-o", out}),
                       {"four.json", "at least 5 references, found 4"});
  test::expect_refused(test::edgepose({"teach", few, "-o", out}), {"kind", "teach-record"});
  test::expect_refused(test::edgepose({"teach", four, "-o", four}), {"an output of its own"});
  test::expect_refused(test::edgepose({"calibrate", "hand-eye", folder / "none.json", "-o", out}),
                       {"none.json"});
  EXPECT_EQ(folder.files(), (std::vector<std::string>{"few.json", "four.json"}));
  EXPECT_EQ(test::edgepose({"teach", four, "--references", "4", "-o", out}).code, 0);
}

}  // namespace
}  // namespace edgepose
