#include "files/bop_set.h"

#include <gmock/gmock.h>

#include "files/bop_json.h"
#include "tests/files/bad_input.h"
#include "tests/shared_data.h"

namespace edgepose {
namespace {

const std::string kObjects = R"({
  "2": {"diameter": 120.5, "name": "gear", "symmetries_discrete": [
          [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],
          [-1,0,0,10, 0,-1,0,20, 0,0,1,0, 0,0,0,1]]},
  "10": {"diameter": 80, "symmetries_continuous": [{"axis": [0, 0, 2], "offset": [1, 2, 3]}]},
  "1": {"diameter": 50, "name": "plain"}})";
const std::string kCameras = R"({
  "0": {"cam_K": [600, 0, 320, 0, 600, 240, 0, 0, 1], "depth_scale": 0.1},
  "1": {"cam_K": [600, 0, 320, 0, 600, 240, 0, 0, 1], "depth_scale": 0.1}})";
const std::string kTruth = R"({"0": [
  {"cam_R_m2c": [0, -1, 0, 1, 0, 0, 0, 0, 1], "cam_t_m2c": [10, -20, 800], "obj_id": 2},
  {"cam_R_m2c": [1, 0, 0, 0, 1, 0, 0, 0, 1], "cam_t_m2c": [0, 0, 900], "obj_id": 1}]})";
const std::string kVisibility = R"({"0": [
  {"px_count_visib": 1200, "visib_fract": 0.75, "occlusion": 0.5}, {"px_count_visib": 30, "visib_fract": 0.1}]})";

std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  return text.replace(at, old.size(), by);
}

/// A whole set; PLYs and PNGs are only looked for, not read, by read_bop_set().
void write_set(const TemporaryFolder& folder) {
  folder.write("models/models_info.json", kObjects);
  for (const char* id : {"000001", "000002", "000010"})
    folder.write("models/obj_" + std::string(id) + ".ply", "ply");
  folder.write("test/000048/scene_camera.json", kCameras);
  folder.write("test/000048/scene_gt.json", kTruth);
  folder.write("test/000048/scene_gt_info.json", kVisibility);
  for (const char* id : {"000000", "000001"})
    folder.write("test/000048/depth/" + std::string(id) + ".png", "png");
}

TEST(BopSet, ReadsObjects) {
  const std::vector<TestObject> objects = parse_bop_objects(kObjects, "models_info.json");
  ASSERT_EQ(objects.size(), 3u);
  EXPECT_EQ(objects[0].id, 1);
  EXPECT_EQ(objects[0].name, "plain");
  EXPECT_FALSE(objects[0].symmetric);
  EXPECT_EQ(objects[1].id, 2);
  EXPECT_DOUBLE_EQ(objects[1].diameter, 0.1205);
  EXPECT_TRUE(objects[1].symmetric);
  ASSERT_EQ(objects[1].symmetries.discrete.size(), 1u) << "the identity is no symmetry";
  const Eigen::Vector3d mapped = objects[1].symmetries.discrete[0] * Eigen::Vector3d(0.001, 0.002, 0.003);
  EXPECT_TRUE(mapped.isApprox(Eigen::Vector3d(0.009, 0.018, 0.003)));
  EXPECT_EQ(objects[2].name, "obj_000010");
  ASSERT_EQ(objects[2].symmetries.continuous.size(), 1u);
  EXPECT_TRUE(objects[2].symmetries.continuous[0].direction.isApprox(Eigen::Vector3d::UnitZ()));
  EXPECT_TRUE(objects[2].symmetries.continuous[0].point.isApprox(Eigen::Vector3d(0.001, 0.002, 0.003)));
}

TEST(BopSet, ReadsAFolder) {
  const TemporaryFolder folder;
  write_set(folder);
  const TestSet set = read_test_set(folder.path());
  EXPECT_EQ(set.name, folder.path().filename().string());
  EXPECT_EQ(set.objects[1].mesh, folder / "models/obj_000002.ply");
  ASSERT_EQ(set.images.size(), 2u);
  const TestImage& image = set.images[0];
  EXPECT_EQ(image.scene_id, 48);
  EXPECT_EQ(image.image_id, 0);
  EXPECT_EQ(image.depth, folder / "test/000048/depth/000000.png");
  EXPECT_TRUE(image.cloud.empty());
  EXPECT_EQ(image.camera.fx, 600);
  EXPECT_DOUBLE_EQ(image.depth_scale, 0.0001);
  ASSERT_EQ(image.truth.size(), 2u);
  EXPECT_EQ(image.truth[0].object_id, 2);
  const Eigen::Vector3d mapped = image.truth[0].camera_T_model * Eigen::Vector3d(0.1, 0, 0);
  EXPECT_TRUE(mapped.isApprox(Eigen::Vector3d(0.01, 0.08, 0.8)));
  EXPECT_EQ(image.truth[0].visible_pixels, 1200);
  EXPECT_EQ(image.truth[0].visible_share, 0.75);
  EXPECT_EQ(image.truth[0].occlusion, 0.5);
  EXPECT_FALSE(image.truth[1].occlusion.has_value());
  EXPECT_TRUE(set.images[1].truth.empty());
}

TEST(BopSet, VisibilityIsOptional) {
  const TemporaryFolder folder;
  write_set(folder);
  std::filesystem::remove(folder / "test/000048/scene_gt_info.json");
  const GroundTruth truth = read_test_set(folder.path()).images[0].truth[0];
  EXPECT_EQ(truth.visible_share, 1);
  EXPECT_EQ(truth.visible_pixels, std::numeric_limits<int>::max());
}

TEST(BopSet, MendsRoundedRotations) {
  const std::string text =
      replaced(kTruth, "0, -1, 0, 1, 0, 0, 0, 0, 1", "0.001,-0.999,0, 0.9985,0,0, 0,0,1.0004");
  const Eigen::Matrix3d rotation = parse_bop_truth(text, "scene_gt.json").at(0)[0].camera_T_model.linear();
  EXPECT_NEAR((rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(rotation.determinant(), 1, 1e-12);
}

TEST(BopSet, NamesMissingFiles) {
  for (const char* name :
       {"models/obj_000010.ply", "test/000048/scene_gt.json", "test/000048/depth/000001.png"}) {
    const TemporaryFolder folder;
    write_set(folder);
    std::filesystem::remove(folder / name);
    expect_input_error([&] { read_test_set(folder.path()); }, {name, "no such file"});
  }
  const TemporaryFolder folder;
  write_set(folder);
  std::filesystem::remove_all(folder / "test");
  expect_input_error([&] { read_test_set(folder.path()); }, {"test: ", "scene_camera.json", "No such file"});
  std::filesystem::create_directories(folder / "test/000001");
  expect_input_error([&] { read_test_set(folder.path()); }, {"test: ", "found none"});
}

TEST(BopSet, ExplainsBothLayouts) {
  const TemporaryFolder folder;
  expect_input_error([&] { read_test_set(folder.path()); },
                     {"models/models_info.json", "<object>-<scene>.xf"});
  expect_input_error([&] { read_test_set(folder / "none"); }, {"none", "no such folder"});
  expect_input_error([&] { read_test_set(folder.write("file", "x")); }, {"file", "a file"});
}

TEST(BopSet, RefusesFilesThatContradictEachOther) {
  const struct {
    const char* file;
    std::string content;
    std::vector<std::string> found;
  } cases[] = {
      {"test/000048/scene_gt.json",
       replaced(kTruth, "\"obj_id\": 2", "\"obj_id\": 7"),
       {"scene_gt.json", "object 7"}},
      {"test/000048/scene_gt.json", replaced(kTruth, "\"0\"", "\"5\""), {"scene_camera.json", "image 5"}},
      {"test/000048/scene_gt_info.json", R"({"0": []})", {"scene_gt_info.json", "each of the 2"}},
      {"test/x/scene_camera.json", kCameras, {"test/x", "scene's number"}},
      {"test/48/scene_camera.json", kCameras, {"48", "each scene number once"}},
      {"test/000048/scene_camera.json", "", {"scene_camera.json", "empty file"}},
      {"models/models_info.json", "{}", {"models_info.json", "at least one object"}},
  };
  for (const auto& test : cases) {
    const TemporaryFolder folder;
    write_set(folder);
    folder.write(test.file, test.content);
    expect_input_error([&] { read_test_set(folder.path()); }, test.found);
  }
}

TEST(BopSet, RefusesUnsoundObjects) {
  const std::pair<std::string, const char*> cases[] = {
      {replaced(kObjects, "120.5", "0"), "2: diameter"},
      {replaced(kObjects, "120.5", "-1"), "2: diameter"},
      {replaced(kObjects, "120.5", "1e9"), "at most 1 km"},
      {replaced(kObjects, "\"diameter\": 120.5,", ""), "\"diameter\""},
      {replaced(kObjects, "\"gear\"", "5"), "a text in quotes"},
      {replaced(kObjects, "[-1,0,0,10", "[-2,0,0,10"), "rotation"},
      {replaced(kObjects, "[-1,0,0,10", "[1,0,0,10"), "mirrors"},
      {replaced(kObjects, "[-1,0,0,10", "[0,0,10"), "an array of 15"},
      {replaced(kObjects, "[0, 0, 2]", "[0, 0, 0]"), "length 0"},
      {replaced(kObjects, "0,0,0,1]]", "10,20,0,1]]"), "row by row"},
      {replaced(kObjects, "\"10\"", "\"ten\""), "'ten'"},
      {replaced(kObjects, "\"10\"", "\"02\""), "2 twice"},
      {replaced(kObjects, "\"10\"", "\"\\n10\""), "'?10'"},
      {"[]", "an object"},
      {"", "JSON"},
      {"{", "JSON"}};
  for (const auto& [text, found] : cases)
    expect_input_error([&] { parse_bop_objects(text, "models_info.json"); }, {"models_info.json", found});
}

TEST(BopSet, RefusesUnsoundTruth) {
  const std::pair<std::string, const char*> cases[] = {
      {replaced(kTruth, "[10, -20, 800]", "[10, -20]"), "an array of 2"},
      {replaced(kTruth, "[10, -20, 800]", "[10, -20, 8e9]"), "millimetres"},
      {replaced(kTruth, "[10, -20, 800]", "[10, -20, null]"), "null"},
      {replaced(kTruth, "0, -1, 0, 1", "0, -1, 0, 1.5"), "rotation"},
      {replaced(kTruth, "0, -1, 0, 1", "0, 1e200, 0, 1"), "rotation"},
      {replaced(kTruth, "0, -1, 0, 1", "0, 1, 0, 1"), "mirrors"},
      {replaced(kTruth, "\"obj_id\": 2", "\"obj_id\": 2.5"), "an integer"},
      {replaced(kTruth, "\"obj_id\": 2", "\"obj\": 2"), "\"obj_id\""},
      {R"({"0": {}})", "an array"}};
  for (const auto& [text, found] : cases)
    expect_input_error([&] { parse_bop_truth(text, "scene_gt.json"); }, {"scene_gt.json", found});
  auto truth = parse_bop_truth(kTruth, "scene_gt.json");
  expect_input_error([&] { add_bop_visibility(replaced(kVisibility, "0.75", "1.75"), "info.json", truth); },
                     {"info.json", "0[0]: visib_fract", "0 to 1"});
}

TEST(BopSet, SurvivesRandomDamage) {
  EXPECT_GT(survive_damage(kObjects, 2000, [](const std::string& text) { parse_bop_objects(text, "o"); }),
            500);
  EXPECT_GT(survive_damage(kCameras, 2000, [](const std::string& text) { parse_bop_cameras(text, "c"); }),
            500);
  EXPECT_GT(survive_damage(kTruth, 2000, [](const std::string& text) { parse_bop_truth(text, "t"); }), 500);
  EXPECT_GT(survive_damage(kVisibility, 2000,
                           [truth = parse_bop_truth(kTruth, "t")](const std::string& text) mutable {
                             add_bop_visibility(text, "v", truth);
                           }),
            300);
}

TEST(BopSet, ReadsSharedSets) {
  const struct {
    const char* name;
    size_t objects, images, instances, symmetric;
  } sets[] = {{"range", 4, 40, 134, 0},
              {"spine", 1, 60, 60, 0},
              {"industrial", 8, 30, 168, 4},
              {"real_dragon", 1, 50, 50, 0},
              {"real_bunny", 1, 18, 18, 0}};
  for (const auto& expected : sets) {
    EDGEPOSE_NEEDS_SHARED(expected.name);
    const TestSet set = read_test_set(shared_data(expected.name));
    EXPECT_EQ(set.name, expected.name);
    EXPECT_EQ(set.objects.size(), expected.objects);
    EXPECT_EQ(set.images.size(), expected.images);
    size_t instances = 0, symmetric = 0;
    for (const TestImage& image : set.images) instances += image.truth.size();
    for (const TestObject& object : set.objects) symmetric += object.symmetric;
    EXPECT_EQ(instances, expected.instances);
    EXPECT_EQ(symmetric, expected.symmetric);
  }
}

}  // namespace
}  // namespace edgepose
