#include "files/bop_set.h"

#include <algorithm>
#include <cstdio>
#include <set>

#include "common/error.h"
#include "files/bop_json.h"
#include "files/json_node.h"
#include "files/number_text.h"
#include "files/text_cursor.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;

std::string padded(int id) {
  char text[32];
  std::snprintf(text, sizeof(text), "%06d", id);
  return text;
}

std::string read_json_file(const fs::path& path) {
  return read_whole_file(path, "a JSON file of a BOP set", kMaxJsonBytes);
}

void need_file(const fs::path& path, const std::string& what) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) throw InputError::at(path.string(), what, "no such file");
}

/// Sub-folders with a scene_camera.json, by rising number.
std::vector<std::pair<int, fs::path>> scene_folders(const fs::path& test) {
  std::vector<std::pair<int, fs::path>> scenes;
  std::error_code error;
  for (fs::directory_iterator entry(test, error), end; !error && entry != end; entry.increment(error)) {
    std::error_code ignored;
    if (!fs::exists(entry->path() / "scene_camera.json", ignored)) continue;
    const auto id = identifier(entry->path().filename().string());
    if (!id)
      throw InputError::at(entry->path().string(), "a scene's number as the folder's name",
                           edgepose::quoted(entry->path().filename().string()));
    scenes.emplace_back(*id, entry->path());
  }
  if (error || scenes.empty())
    throw InputError::at(test.string(), "scenes of a BOP set: test/NNNNNN/scene_camera.json",
                         error ? error.message() : "none");
  std::sort(scenes.begin(), scenes.end());
  for (size_t i = 1; i < scenes.size(); ++i)
    if (scenes[i].first == scenes[i - 1].first)
      throw InputError::at(scenes[i].second.string(), "each scene number once",
                           "the same as " + scenes[i - 1].second.string());
  return scenes;
}

std::vector<TestObject> read_objects(const fs::path& models) {
  const fs::path info = models / "models_info.json";
  std::vector<TestObject> objects = parse_bop_objects(read_json_file(info), info.string());
  for (TestObject& object : objects) {
    object.mesh = models / ("obj_" + padded(object.id) + ".ply");
    need_file(object.mesh, "the mesh of object " + std::to_string(object.id) + " in models_info.json");
  }
  return objects;
}

std::map<int, std::vector<GroundTruth>> read_truth(const fs::path& scene, const std::set<int>& known) {
  const fs::path path = scene / "scene_gt.json";
  auto truth = parse_bop_truth(read_json_file(path), path.string());
  for (const auto& [image, instances] : truth)
    for (const GroundTruth& instance : instances)
      if (!known.contains(instance.object_id))
        throw InputError::at(path.string() + ": " + std::to_string(image), "objects of models_info.json",
                             "object " + std::to_string(instance.object_id));
  const fs::path visibility = scene / "scene_gt_info.json";
  std::error_code ignored;
  if (fs::exists(visibility, ignored))
    add_bop_visibility(read_json_file(visibility), visibility.string(), truth);
  return truth;
}

void read_scene(const fs::path& scene, int scene_id, const std::set<int>& known,
                std::vector<TestImage>& images) {
  const fs::path camera_path = scene / "scene_camera.json";
  const auto cameras = parse_bop_cameras(read_json_file(camera_path), camera_path.string());
  auto truth = read_truth(scene, known);
  for (const auto& [image_id, instances] : truth)
    if (!cameras.contains(image_id))
      throw InputError::at(camera_path.string(), "image " + std::to_string(image_id) + " of scene_gt.json",
                           "none");
  for (const auto& [image_id, camera] : cameras) {
    TestImage image;
    image.scene_id = scene_id;
    image.image_id = image_id;
    image.depth = scene / "depth" / (padded(image_id) + ".png");
    need_file(image.depth, "the depth image " + std::to_string(image_id) + " of scene_camera.json");
    image.camera = camera.camera;
    image.depth_scale = camera.depth_scale;
    image.truth = std::move(truth[image_id]);
    images.push_back(std::move(image));
  }
}

}  // namespace

bool looks_like_bop(const fs::path& folder) {
  std::error_code ignored;
  return fs::exists(folder / "models" / "models_info.json", ignored);
}

TestSet read_bop_set(const fs::path& folder) {
  TestSet set;
  set.name = folder_name(folder);
  set.objects = read_objects(folder / "models");
  set.descriptions = {folder / "models" / "models_info.json"};
  std::set<int> known;
  for (const TestObject& object : set.objects) known.insert(object.id);
  for (const auto& [scene_id, scene] : scene_folders(folder / "test")) {
    read_scene(scene, scene_id, known, set.images);
    for (const char* file : {"scene_camera.json", "scene_gt.json", "scene_gt_info.json"})
      set.descriptions.push_back(scene / file);
  }
  return set;
}

}  // namespace edgepose
