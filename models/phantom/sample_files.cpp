#include "models/phantom/sample_files.h"

#include <Eigen/Geometry>
#include <array>
#include <nlohmann/json.hpp>

#include "common/atomic_file.h"
#include "files/depth_file.h"

namespace edgepose::phantom {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDepthScale = 0.001;  // [m] per unit

void write_json(const std::filesystem::path& path, const Json& json, int indent = 1) {
  write_file_atomically(path, json.dump(indent) + "\n");
}

Json list(const Eigen::Vector3d& v) { return Json::array({v.x(), v.y(), v.z()}); }

/// As BOP writes poses: R row by row, t in millimetres.
Json pose(const RigidTransform& camera_T_model) {
  Json rotation = Json::array();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) rotation.push_back(camera_T_model.linear()(row, column));
  }
  return {{"cam_R_m2c", rotation}, {"cam_t_m2c", list(camera_T_model.translation() * 1000)}, {"obj_id", 1}};
}

Json model_info(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  const Eigen::Vector3d low = box.min().cast<double>() * 1000, size = box.sizes().cast<double>() * 1000;
  return {{"name", kName},      {"diameter", 1000 * diameter(mesh)},
          {"min_x", low.x()},   {"min_y", low.y()},
          {"min_z", low.z()},   {"size_x", size.x()},
          {"size_y", size.y()}, {"size_z", size.z()}};
}

}  // namespace

double diameter(const Mesh& mesh) {
  double squared = 0;
  for (size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      squared = std::max(squared, static_cast<double>((mesh.vertices[i] - mesh.vertices[j]).squaredNorm()));
    }
  }
  return std::sqrt(squared);
}

void write_drill_plan(const std::filesystem::path& path, const std::vector<DrillTarget>& targets,
                      double diameter_mm) {
  Json holes = Json::array();
  for (const DrillTarget& target : targets) {
    holes.push_back({{"name", target.name},
                     {"entry_mm", list(target.entry)},
                     {"axis", list(target.axis)},
                     {"depth_mm", target.depth},
                     {"diameter_mm", target.diameter},
                     {"tolerance_mm", target.tolerance},
                     {"tolerance_deg", target.tolerance_deg}});
  }
  write_json(path, {{"model", kName}, {"model_diameter_mm", diameter_mm}, {"targets", holes}});
}

void write_scene(const std::filesystem::path& folder, const SampleScene& scene) {
  std::filesystem::create_directories(folder);
  write_depth_png(folder / "depth.png", scene.depth, kDepthScale);
  write_json(folder / "camera.json", {{"cx", kSampleCamera.cx},
                                      {"cy", kSampleCamera.cy},
                                      {"depth_scale", 1000 * kDepthScale},
                                      {"fx", kSampleCamera.fx},
                                      {"fy", kSampleCamera.fy},
                                      {"height", kSampleHeight},
                                      {"width", kSampleWidth}});
  Json truth = pose(scene.camera_T_model);
  truth["mesh"] = "../phantom.ply";
  write_json(folder / "truth.json", {{"0", Json::array({truth})}});
}

void write_sample_set(const std::filesystem::path& folder, const Mesh& mesh,
                      const std::vector<SampleScene>& scenes) {
  const std::filesystem::path test = folder / "test" / "000001";
  std::filesystem::create_directories(folder / "models");
  std::filesystem::create_directories(test / "depth");
  write_json(folder / "models" / "models_info.json", {{"1", model_info(mesh)}});

  Json cameras, truths, infos;
  for (size_t i = 0; i < scenes.size(); ++i) {
    const SampleScene& scene = scenes[i];
    const std::string image = std::to_string(i);
    write_depth_png(test / "depth" / (std::string(6 - image.size(), '0') + image + ".png"), scene.depth,
                    kDepthScale);
    cameras[image] = {
        {"cam_K",
         {kSampleCamera.fx, 0.0, kSampleCamera.cx, 0.0, kSampleCamera.fy, kSampleCamera.cy, 0.0, 0.0, 1.0}},
        {"depth_scale", 1000 * kDepthScale}};
    truths[image] = Json::array({pose(scene.camera_T_model)});
    infos[image] =
        Json::array({{{"px_count_all", scene.pixels_alone},
                      {"px_count_visib", scene.pixels_visible},
                      {"visib_fract", static_cast<double>(scene.pixels_visible) / scene.pixels_alone},
                      {"occlusion", scene.occlusion}}});
  }
  write_json(test / "scene_camera.json", cameras);
  write_json(test / "scene_gt.json", truths);
  write_json(test / "scene_gt_info.json", infos);
}

}  // namespace edgepose::phantom
