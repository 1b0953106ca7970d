#include "files/camera_file.h"

#include <gmock/gmock.h>

#include <cmath>

#include "files/camera_check.h"
#include "tests/files/bad_input.h"
#include "tests/shared_data.h"

namespace edgepose {
namespace {

const std::string kSceneCamera = R"({
  "3": {"cam_K": [600.5, 0, 320.25, 0, 601.5, 240.75, 0, 0, 1], "depth_scale": 0.1},
  "12": {"cam_K": [700, 0, 310, 0, 701, 230, 0, 0, 1], "depth_scale": 1.0}})";
const std::string kCameraJson =
    R"({"cx": 325.26, "cy": 242.05, "depth_scale": 0.5, "fx": 572.41, "fy": 573.57, "height": 480, "width": 640})";
const std::string kCalibrationYaml = R"(image_width: 640
image_height: 480
camera_name: depth
camera_matrix:
  rows: 3
  cols: 3
  data: [570.5, 0., 319.5, 0., 571.5, 239.5, 0., 0., 1.]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [0., 0., 0., 0., 0.]
)";
const std::string kEchoYaml = R"(header:
  seq: 12
  frame_id: "camera_depth_optical_frame"
height: 480
width: 640
distortion_model: "plumb_bob"
D: [0.01, 0.0, 0.0, 0.0, 0.0]
K: [570.5, 0.0, 319.5, 0.0, 571.5, 239.5, 0.0, 0.0, 1.0]
R: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
---
)";

void expect_camera(const Camera& camera, double fx, double fy, double cx, double cy) {
  EXPECT_EQ(camera.fx, fx);
  EXPECT_EQ(camera.fy, fy);
  EXPECT_EQ(camera.cx, cx);
  EXPECT_EQ(camera.cy, cy);
}

TEST(CameraFile, ReadsNumbers) {
  const CameraFile file = read_camera("600, 601.5,320,240.25");
  expect_camera(file.camera, 600, 601.5, 320, 240.25);
  EXPECT_FALSE(file.depth_scale_given);
  EXPECT_EQ(file.depth_scale, 0.001);
}

TEST(CameraFile, RefusesUnsoundNumbers) {
  const std::pair<const char*, const char*> cases[] = {
      {"600,600,320", "found 3"},     {"600,600,320,240,1", "found 5"},
      {"600,x,320,240", "'x'"},       {"600,,320,240", "''"},
      {"0,600,320,240", "fx"},        {"600,-600,320,240", "fy"},
      {"600,600,-1e7,240", "cx"},     {"600,600,320,1e7", "cy"},
      {"1e-30,600,320,240", "fx"},    {"600,0.001,320,240", "fy"},
      {"600,600,nan,240", "'nan'"},   {"inf,600,320,240", "'inf'"},
      {"1e9,600,320,240", "fx"},      {"600,600,320,240mm", "'240mm'"},
      {"1e999,600,320,240", "1e999"}, {",,,", "''"}};
  for (const auto& [spec, found] : cases)
    expect_input_error([&] { read_camera(spec); }, {"intrinsics", found});
}

TEST(CameraCheck, GoesByTheSizeOfTheImage) {
  EXPECT_NO_THROW(check_camera({600, 600, -700, 900}, "K", 640, 480)) << "cut out of a larger image";
  EXPECT_NO_THROW(check_camera({600, 600, 320, -400}, "K", 640, 16));
  EXPECT_EQ(off_centre_warning({600, 600, 0, 479.5}, 640, 480), "");
  EXPECT_THAT(off_centre_warning({600, 600, -1, 240}, 640, 480), testing::HasSubstr("640 x 480"));
  for (const double fx : {0.0, -1.0, 1e-30, 0.001, 63.0, 64001.0, std::nan("")})
    expect_input_error([&] { check_camera({fx, 600, 320, 240}, "K", 640, 480); }, {"K: expected fx", "640"});
  for (const double cx : {-6401.0, 6401.0, std::nan("")})
    expect_input_error([&] { check_camera({600, 600, cx, 240}, "K", 640, 480); }, {"K: expected cx", "640"});
}

TEST(CameraFile, RefusesWhatIsNeitherFileNorNumbers) {
  expect_input_error([] { read_camera("no_such_camera.json"); },
                     {"no_such_camera.json", "fx,fy,cx,cy", "no such file"});
  expect_input_error([] { read_camera(""); }, {"no such file"});
  const TemporaryFolder folder;
  expect_input_error([&] { read_camera(folder.path().string()); }, {"a folder"});
  expect_input_error([&] { read_camera(folder.write("e.json", "").string()); }, {"e.json", "empty file"});
  expect_input_error([&] { read_camera(folder.write("b.json", " \n").string()); }, {"b.json", "empty file"});
}

TEST(CameraFile, ReadsSceneCameraByImage) {
  const TemporaryFolder folder;
  const std::string path = folder.write("scene_camera.json", kSceneCamera).string();
  const CameraFile third = read_camera(path, 3);
  expect_camera(third.camera, 600.5, 601.5, 320.25, 240.75);
  EXPECT_DOUBLE_EQ(third.depth_scale, 0.0001);
  EXPECT_TRUE(third.depth_scale_given);
  expect_camera(read_camera(path, 12).camera, 700, 701, 310, 230);
  expect_input_error([&] { read_camera(path, 4); }, {"scene_camera.json", "image 4", "3 to 12"});
  expect_input_error([&] { read_camera(path); }, {"scene_camera.json", "number of the image"});
}

TEST(CameraFile, NeedsNoImageWhereAllCamerasAreEqual) {
  const std::string same = R"({"1": {"cam_K": [700, 0, 310, 0, 701, 230, 0, 0, 1]},
                               "2": {"cam_K": [700, 0, 310, 0, 701, 230, 0, 0, 1]}})";
  const CameraFile file = parse_camera_file(same, "c.json");
  expect_camera(file.camera, 700, 701, 310, 230);
  EXPECT_EQ(file.depth_scale, 0.001);
}

TEST(CameraFile, ReadsCameraJson) {
  const CameraFile file = parse_camera_file(kCameraJson, "camera.json");
  expect_camera(file.camera, 572.41, 573.57, 325.26, 242.05);
  EXPECT_EQ(file.width, 640);
  EXPECT_EQ(file.height, 480);
  EXPECT_DOUBLE_EQ(file.depth_scale, 0.0005);
}

TEST(CameraFile, ReadsCameraInfoYaml) {
  const CameraFile calibration = parse_camera_file(kCalibrationYaml, "ost.yaml");
  expect_camera(calibration.camera, 570.5, 571.5, 319.5, 239.5);
  EXPECT_EQ(calibration.width, 640);
  EXPECT_THAT(calibration.warnings, testing::IsEmpty());

  const CameraFile echo = parse_camera_file(kEchoYaml, "echo.yaml");
  expect_camera(echo.camera, 570.5, 571.5, 319.5, 239.5);
  EXPECT_EQ(echo.height, 480);
  EXPECT_THAT(echo.warnings, testing::ElementsAre(testing::HasSubstr("distortion")));
  EXPECT_FALSE(echo.depth_scale_given);
}

TEST(CameraFile, ReadsRos2Echo) {
  const std::string text =
      "height: 480\nwidth: 640\nd:\n- 0.0\n- 0.0\nk:\n- 500.0\n- 0.0\n- 320.0\n- 0.0\n- 501.0\n"
      "- 240.0\n- 0.0\n- 0.0\n- 1.0\n";
  expect_camera(parse_camera_file(text, "info.yaml").camera, 500, 501, 320, 240);
}

TEST(CameraFile, RefusesUnsoundJson) {
  const std::pair<std::string, const char*> cases[] = {
      {replaced(kSceneCamera, "600.5", "0"), "fx"},
      {replaced(kSceneCamera, "601.5", "-601.5"), "fy"},
      {replaced(kSceneCamera, "600.5", "NaN"), "JSON"},
      {replaced(kSceneCamera, "600.5", "\"600.5\""), "the text '600.5'"},
      {replaced(kSceneCamera, "600.5", "null"), "null"},
      {replaced(kSceneCamera, "600.5, ", ""), "an array of 8"},
      {replaced(kSceneCamera, "600.5", "1e400"), "JSON"},
      {replaced(kSceneCamera, "cam_K", "cam_R"), "\"cam_K\""},
      {replaced(kSceneCamera, "0.1", "0"), "depth scale"},
      {replaced(kSceneCamera, "0.1", "-1"), "depth scale"},
      {replaced(kSceneCamera, "0.1", "1000"), "depth scale"},
      {replaced(kSceneCamera, "600.5, 0, 320.25, 0, 601.5, 240.75, 0, 0, 1", "600.5,0,0,0,601.5,0,320,240,1"),
       "transpose"},
      {replaced(kSceneCamera, "\"3\"", "\"three\""), "other members"},
      {replaced(kSceneCamera, "\"3\"", "\"-3\""), "other members"},
      {kSceneCamera.substr(0, kSceneCamera.size() - 5), "cut short"},
      {replaced(kCameraJson, "\"fx\"", "\"f\""), "\"fx\""},
      {replaced(kCameraJson, "325.26", "7250.26"), "another resolution"},
      {replaced(kCameraJson, "572.41", "-572.41"), "fx"},
      {R"({"camera": {}})", "other members"},
      {"{}", "at least one image"}};
  for (const auto& [text, found] : cases)
    expect_input_error([&] { parse_camera_file(text, "camera.json", 3); }, {"camera.json", found});
}

TEST(CameraFile, RefusesUnsoundYaml) {
  const std::pair<std::string, const char*> cases[] = {
      {replaced(kCalibrationYaml, "570.5", "0"), "fx"},
      {replaced(kCalibrationYaml, "570.5", ".nan"), "'.nan'"},
      {replaced(kCalibrationYaml, "570.5", "nan"), "'nan'"},
      {replaced(kCalibrationYaml, "571.5", "-571.5"), "fy"},
      {replaced(kCalibrationYaml, "570.5, ", ""), "8 values"},
      {replaced(kCalibrationYaml, "camera_matrix", "cam"), "camera_matrix"},
      {replaced(kCalibrationYaml, "[570.5, 0., 319.5, 0., 571.5, 239.5, 0., 0., 1.]", "7"),
       "list of numbers"},
      {replaced(kCalibrationYaml, "319.5", "6400.5"), "another resolution"},
      {replaced(kCalibrationYaml, "image_width: 640", "image_width: wide"), "'wide'"},
      {replaced(kEchoYaml, "K: [570.5, 0.0, 319.5, 0.0, 571.5, 239.5, 0.0, 0.0, 1.0]",
                "K: [0, 0, 0, 0, 0, 0, 0, 0, 0]"),
       "calibrate"},
      {replaced(kEchoYaml, "[570.5", "[[570.5]"), "nested list"},
      {"- a\n- b\n", "no YAML map"},
      {"just text", "no YAML map"},
      {"a: [1, 2", "line"},
      {"a: *nowhere", "line"},
      {std::string("K: \0", 4), "binary"},
      {"k: \"\\\x9c\"", "escape character: ?"},
      {"k: \"\\\n\x10\\\x10\"", "line"},
      {std::string(3000, '['), "line"},
      {std::string(3000, '{').insert(0, " - "), "line"}};
  for (const auto& [text, found] : cases)
    expect_input_error([&] { parse_camera_file(text, "info.yaml"); }, {"info.yaml", found});
}

TEST(CameraFile, SurvivesRandomDamage) {
  for (const std::string& good :
       {kSceneCamera, kCameraJson, kCalibrationYaml, kEchoYaml, std::string("600,600,320,240")})
    survive_damage(good, 2000, [](const std::string& text) {
      const Camera camera = parse_camera_file(text, "damaged", 3).camera;
      for (const double value : {camera.fx, camera.fy}) EXPECT_TRUE(value >= 1 && value <= 1e6);
      for (const double value : {camera.cx, camera.cy}) EXPECT_TRUE(std::abs(value) <= 1e6);
    });
}

TEST(CameraFile, ReadsSharedSets) {
  EDGEPOSE_NEEDS_SHARED("range");
  const CameraFile file = read_camera(shared_data("range/test/000001/scene_camera.json").string(), 7);
  expect_camera(file.camera, 700, 700, 239.5, 199.5);
  EXPECT_DOUBLE_EQ(file.depth_scale, 0.0001);
}

}  // namespace
}  // namespace edgepose
