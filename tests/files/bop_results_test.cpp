#include "files/bop_results.h"

#include <gmock/gmock.h>

#include "tests/files/bad_input.h"

namespace edgepose {
namespace {

BopResult random_result(std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  BopResult result;
  result.scene_id = static_cast<int>(random() % 50);
  result.image_id = static_cast<int>(random() % 5000);
  result.object_id = static_cast<int>(random() % 30);
  result.score = uniform(random) * 1000;
  result.time = 0.5 + uniform(random) / 2;
  const Eigen::Vector4d q(uniform(random), uniform(random), uniform(random), uniform(random));
  result.camera_T_model.linear() = Eigen::Quaterniond(q).normalized().toRotationMatrix();
  result.camera_T_model.translation() =
      Eigen::Vector3d(uniform(random), uniform(random), 1 + uniform(random));
  return result;
}

TEST(BopResults, WritesWhatBopExpects) {
  BopResult result;
  result.scene_id = 1;
  result.image_id = 12;
  result.object_id = 5;
  result.score = 0.75;
  result.camera_T_model.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  result.camera_T_model.translation() << 0.01, -0.0205, 0.8;
  result.time = 0.125;
  EXPECT_EQ(format_bop_results({result}),
            "scene_id,im_id,obj_id,score,R,t,time\n1,12,5,0.75,0 -1 0 1 0 0 0 0 1,10 -20.5 800,0.125\n");
  EXPECT_EQ(format_bop_results({}), "scene_id,im_id,obj_id,score,R,t,time\n");
}

TEST(BopResults, KeepsNineDigits) {
  const TemporaryFolder folder;
  std::mt19937_64 random(3);
  std::vector<BopResult> results;
  for (int i = 0; i < 200; ++i) results.push_back(random_result(random));
  write_bop_results(folder / "r.csv", results);
  const std::vector<BopResult> read = read_bop_results(folder / "r.csv");
  ASSERT_EQ(read.size(), results.size());
  for (size_t i = 0; i < read.size(); ++i) {
    EXPECT_EQ(read[i].scene_id, results[i].scene_id);
    EXPECT_EQ(read[i].image_id, results[i].image_id);
    EXPECT_EQ(read[i].object_id, results[i].object_id);
    EXPECT_NEAR(read[i].score, results[i].score, 1e-6);
    EXPECT_NEAR(read[i].time, results[i].time, 1e-9);
    EXPECT_LT((read[i].camera_T_model.matrix() - results[i].camera_T_model.matrix()).norm(), 1e-8);
  }
}

TEST(BopResults, ReadsFilesOfOthers) {
  EXPECT_EQ(parse_bop_results("1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,-1", "r.csv").at(0).time, -1);
  const auto results = parse_bop_results(
      "scene_id,im_id,obj_id,score,R,t,time\r\n1,2,3, 5e-1 ,1.0 0.0 0 0 1 0 0  0 1, 1 2 3e2 ,0.1\r\n\r\n",
      "r.csv");
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].score, 0.5);
  EXPECT_DOUBLE_EQ(results[0].camera_T_model.translation().z(), 0.3);
  EXPECT_TRUE(parse_bop_results("scene_id,im_id,obj_id,score,R,t,time\n", "r.csv").empty());
}

TEST(BopResults, NamesFileAndLine) {
  const std::string good = "1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.1";
  const std::pair<const char*, const char*> cases[] = {
      {"1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3", "found 6"},
      {"1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.1,7", "found 8"},
      {"x,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.1", "scene_id, found 'x'"},
      {"1,2.5,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.1", "im_id, found '2.5'"},
      {"1,2,-3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.1", "obj_id"},
      {"1,2,99999999999,0.5,1 0 0 0 1 0 0 0 1,1 2 3,0.1", "obj_id"},
      {"1,2,3,nan,1 0 0 0 1 0 0 0 1,1 2 3,0.1", "score, found 'nan'"},
      {"1,2,3,0.5,1 0 0 0 1 0 0 0,1 2 3,0.1", "9 values as R, found 8"},
      {"1,2,3,0.5,2 0 0 0 1 0 0 0 1,1 2 3,0.1", "rotation"},
      {"1,2,3,0.5,-1 0 0 0 1 0 0 0 1,1 2 3,0.1", "mirrors"},
      {"1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 inf,0.1", "t, found 'inf'"},
      {"1,2,3,0.5,1 0 0 0 1 0 0 0 1,1 2 3,", "time, found ''"},
      {"scene_id,im_id,obj_id,score,R,t,time", "scene_id, found 'scene_id'"}};
  for (const auto& [line, found] : cases)
    expect_input_error([&] { parse_bop_results(good + "\n" + line + "\n", "r.csv"); },
                       {"r.csv, line 2", found});
  expect_input_error([] { read_bop_results("no_results.csv"); }, {"no_results.csv", "no such file"});
}

TEST(BopResults, SurvivesRandomDamage) {
  std::mt19937_64 random(5);
  const std::string good = format_bop_results({random_result(random), random_result(random)});
  EXPECT_GT(survive_damage(good, 4000, [](const std::string& text) { parse_bop_results(text, "d.csv"); }),
            1000);
}

TEST(BopResults, LeavesNothingBehindIfItCannotWrite) {
  const TemporaryFolder folder;
  expect_input_error([&] { write_bop_results(folder / "no/r.csv", {}); }, {"r.csv"});
  std::filesystem::create_directory(folder / "taken");
  expect_input_error([&] { write_bop_results(folder / "taken", {}); }, {"taken"});
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace edgepose
