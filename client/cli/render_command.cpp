#include "client/cli/render_command.h"

#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <regex>

#include "client/cli/mesh_input.h"
#include "client/cli/option_checks.h"
#include "client/cli/render_scene.h"
#include "common/atomic_file.h"
#include "common/error.h"
#include "common/naming.h"
#include "common/output_target.h"
#include "files/camera_check.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "files/mesh_file.h"
#include "render/depth_renderer.h"
#include "render/overlay.h"
#include "render/sensor_model.h"

namespace edgepose {
namespace {

constexpr const char* kRenderExamples =
    R"(Writes OUT.png (16 bit) and, beside it, OUT_camera.json (as BOP's camera.json, for match --intrinsics) and
OUT_truth.json (as BOP's scene_gt.json; render --scene reads it again). The camera looks along z, x is right,
y is down.

Examples:
  edgepose render --mesh models/phantom/phantom.ply --pose "0 0 400 90 0 0" -o out.png
  edgepose render --mesh bolt.stl --pose "-30 0 600 0 45 0" --mesh nut.stl --pose "40 5 620 0 0 90" \
      --camera 600,600,319.5,239.5 --size 640x480 --sensor structured_light --seed 7 -o two.png
  edgepose render --scene out_truth.json --sensor laser --overlay seen.png -o again.png)";

constexpr int kDefaultWidth = 640, kDefaultHeight = 576;

struct RenderCommand {
  std::vector<std::string> meshes, poses;
  std::filesystem::path scene, output, overlay;
  LengthUnit unit = LengthUnit::kMillimetre;
  std::string camera = "504,504,319.5,287.5", size, sensor = "ideal";
  int image = 0;
  uint64_t seed = 1;
  double depth_scale_mm = 0;
  int threads = 0;

  void run(bool image_given) const;
  void check_outputs(const std::vector<PlacedMesh>& placed) const;
  std::vector<PlacedMesh> objects(bool image_given) const;
  std::pair<int, int> image_size(const CameraFile& file) const;
};

std::vector<PlacedMesh> RenderCommand::objects(bool image_given) const {
  if (!scene.empty()) {
    if (!meshes.empty() || !poses.empty())
      throw InputError("--scene: expected alone, found --mesh or --pose too");
    return read_scene_file(scene, image_given ? std::optional<int>(image) : std::nullopt);
  }
  if (meshes.empty()) throw InputError("render: expected --mesh with --pose, or --scene; found neither");
  if (meshes.size() != 1 && meshes.size() != poses.size()) {
    throw InputError::at("--pose", "one for each of the " + std::to_string(meshes.size()) + " meshes",
                         std::to_string(poses.size()));
  }
  if (poses.empty()) throw InputError("--pose: expected one for each --mesh, found none");
  std::vector<PlacedMesh> result;
  for (size_t i = 0; i < poses.size(); ++i) {
    const size_t mesh = meshes.size() == 1 ? 0 : i;  // one mesh may be placed several times
    result.push_back({meshes[mesh], parse_pose(poses[i]), static_cast<int>(mesh) + 1});
  }
  return result;
}

std::pair<int, int> RenderCommand::image_size(const CameraFile& file) const {
  if (size.empty()) return {file.width.value_or(kDefaultWidth), file.height.value_or(kDefaultHeight)};
  std::smatch sides;
  if (!std::regex_match(size, sides, std::regex("([1-9][0-9]{0,4})x([1-9][0-9]{0,4})"))) {
    throw InputError::at("--size", "WIDTHxHEIGHT in pixels, as 640x576", "'" + size + "'");
  }
  const int width = std::stoi(sides[1]), height = std::stoi(sides[2]);
  if (width > static_cast<int>(kMaxDepthSide) || height > static_cast<int>(kMaxDepthSide) ||
      static_cast<uint64_t>(width) * static_cast<uint64_t>(height) > kMaxDepthPixels) {
    throw InputError::at("--size", "at most 16384 pixels a side and 64 million in all", "'" + size + "'");
  }
  return {width, height};
}

std::string camera_text(const Camera& camera, int width, int height, double depth_scale_mm) {
  return nlohmann::ordered_json{{"cx", camera.cx}, {"cy", camera.cy}, {"depth_scale", depth_scale_mm},
                                {"fx", camera.fx}, {"fy", camera.fy}, {"height", height},
                                {"width", width}}
             .dump(1) +
         "\n";
}

std::filesystem::path beside(const std::filesystem::path& output, const std::string& ending) {
  return output.parent_path() / (output.stem().string() + ending);
}

void RenderCommand::check_outputs(const std::vector<PlacedMesh>& placed) const {
  std::vector<std::filesystem::path> taken = {scene, camera};
  for (const PlacedMesh& object : placed) taken.push_back(object.mesh);
  std::vector<std::filesystem::path> outputs = {output, beside(output, "_camera.json"),
                                                beside(output, "_truth.json")};
  if (!overlay.empty()) outputs.push_back(overlay);
  for (const std::filesystem::path& path : outputs) {
    check_output(path, taken);
    taken.push_back(path);
  }
}

void RenderCommand::run(bool image_given) const {
  const SensorModel model = SensorModel::named(sensor);
  const std::vector<PlacedMesh> placed = objects(image_given);
  const CameraFile file = read_camera(camera);
  const auto [width, height] = image_size(file);
  check_camera(file.camera, camera, width, height);
  check_outputs(placed);
  // Finer than the sensor measures, unless the sensor itself gives whole millimetres.
  const double unit_mm = depth_scale_mm > 0 ? depth_scale_mm : model.depth_step >= 1e-3 ? 1 : 0.1;

  std::map<std::filesystem::path, Mesh> loaded;
  DepthRenderer renderer;
  for (const PlacedMesh& object : placed) {
    const auto [entry, is_new] = loaded.try_emplace(object.mesh);
    Mesh& mesh = entry->second;
    if (is_new) mesh = read_mesh(object.mesh, unit);
    naming(object.mesh.string(), [&] { renderer.add(mesh, object.camera_T_model); });
  }
  const RenderedView view = renderer.render(file.camera, width, height, threads);
  const DepthImage depth = apply_sensor(view.depth, file.camera, model, seed, threads);
  const auto measured = std::count_if(depth.depth.begin(), depth.depth.end(), [](float z) { return z > 0; });
  if (measured == 0) {
    throw InputError::at("render", "an object in view", "an empty image",
                         "check poses (mm, degrees), --unit and --camera");
  }

  FileGroup files;  // one is worth nothing without the others
  files.add(output, encode_depth_png(depth, output.string(), unit_mm / 1000));
  files.add(beside(output, "_camera.json"), camera_text(file.camera, width, height, unit_mm));
  files.add(beside(output, "_truth.json"), scene_file_text(placed, output.parent_path()));
  if (!overlay.empty()) {
    std::vector<OverlayPose> poses_drawn;
    poses_drawn.reserve(placed.size());
    for (const PlacedMesh& object : placed) {
      poses_drawn.push_back(
          {&loaded.at(object.mesh), object.camera_T_model, object.mesh.stem().string(), {}, {}});
    }
    OverlayOptions options;
    options.threads = threads;
    files.add(overlay, encode_png(draw_overlay(depth, file.camera, poses_drawn, options)));
  }
  files.commit();
  std::cout << output.string() << ": " << width << "x" << height << ", " << placed.size()
            << (placed.size() == 1 ? " object, " : " objects, ") << measured << " pixels measured (" << sensor
            << ", seed " << seed << ", " << unit_mm << " mm per unit)\n";
}

}  // namespace

void add_render_command(CLI::App& app) {
  auto command = std::make_shared<RenderCommand>();
  CLI::App* render =
      app.add_subcommand("render", "Render a depth image of meshes, as a sensor would see them");
  render->add_option("--mesh", command->meshes, "Mesh file (PLY, STL, OBJ); once for each object")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  render
      ->add_option("--pose", command->poses,
                   "Where that mesh is: \"x y z rx ry rz\" in mm and, as a rotation vector, degrees; "
                   "several for one mesh place it several times")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  render->add_option("--scene", command->scene, "Meshes and poses from a file instead (see OUT_truth.json)");
  CLI::Option* image =
      render->add_option("--image", command->image, "Image number in the scene file, if it has several");
  add_unit_option(*render, "--unit", command->unit, "the meshes");
  render->add_option("--camera", command->camera, "fx,fy,cx,cy in pixels, or a camera file")
      ->capture_default_str();
  render->add_option("--size", command->size, "WIDTHxHEIGHT (default: the camera file's, else 640x576)");
  render->add_option("--sensor", command->sensor, "ideal, laser, structured_light or time_of_flight")
      ->capture_default_str();
  render->add_option("--seed", command->seed, "Of the noise; the same seed gives the same image")
      ->capture_default_str();
  render
      ->add_option("--depth-scale", command->depth_scale_mm,
                   "Millimetres in one unit of the PNG (default: 1 for time_of_flight, else 0.1)")
      ->check(number_between(1e3 * kMinDepthScale, 1e3 * kMaxDepthScale));
  add_output_option(*render, "-o,--output", command->output, "Depth image to write (PNG)")->required();
  add_output_option(*render, "--overlay", command->overlay,
                    "Also draw the objects' outlines over the depth image");
  render->add_option("--threads", command->threads, "Threads; 0 = all cores; never changes the result")
      ->check(CLI::Range(0, 256));
  render->footer(kRenderExamples);
  render->callback([command, image] { command->run(image->count() > 0); });
}

}  // namespace edgepose
