#include "client/service/depth_files.h"

#include <algorithm>
#include <optional>

#include "common/error.h"
#include "files/bop_json.h"
#include "files/bop_set.h"
#include "files/camera_check.h"
#include "files/camera_file.h"
#include "files/depth_file.h"
#include "files/number_text.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;

bool is_png(const fs::path& path) {
  const std::string extension = path.extension().string();
  return extension == ".png" || extension == ".PNG";
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::vector<fs::path> images;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure))
    if (is_png(entry->path())) images.push_back(entry->path());
  if (failure || images.empty())
    throw InputError::at(folder.string(), "a folder with depth images (PNG)",
                         failure ? failure.message() : "none in it");
  std::sort(images.begin(), images.end());
  return images;
}

/// The camera that all images share, else that of the image which the file is named after.
CameraFile camera_of(const fs::path& image, const std::string& intrinsics) {
  if (intrinsics.empty())
    throw InputError(image.string() +
                     ": --intrinsics is missing: fx,fy,cx,cy, a BOP scene_camera.json or a ROS camera_info "
                     "YAML (a BOP scene folder brings its own)");
  try {
    return read_camera(intrinsics);
  } catch (const InputError&) {
    const auto number = identifier(image.stem().string());
    if (!number) throw;
    return read_camera(intrinsics, number);
  }
}

void add_plain(const std::vector<fs::path>& images, const DepthFileOptions& options,
               std::vector<DepthFile>& files) {
  for (const fs::path& image : images) {
    const CameraFile camera = camera_of(image, options.intrinsics);
    files.push_back(
        {image, camera.camera, camera.depth_scale, camera.width.value_or(0), camera.height.value_or(0)});
  }
}

void add_bop_scene(const fs::path& folder, std::vector<DepthFile>& files) {
  const fs::path list = folder / "scene_camera.json";
  const auto cameras =
      parse_bop_cameras(read_whole_file(list, "a BOP scene's cameras", size_t{64} << 20), list.string());
  for (const auto& [number, camera] : cameras) {
    const std::string digits = std::to_string(number);
    const std::string padded = std::string(digits.size() < 6 ? 6 - digits.size() : 0, '0') + digits;
    files.push_back({folder / "depth" / (padded + ".png"), camera.camera, camera.depth_scale, 0, 0});
  }
}

void add(const fs::path& path, const DepthFileOptions& options, std::vector<DepthFile>& files) {
  std::error_code ignored;
  if (!fs::is_directory(path, ignored)) return add_plain({path}, options, files);
  if (looks_like_bop(path)) {
    for (const TestImage& image : read_bop_set(path).images)
      files.push_back({image.depth, image.camera, image.depth_scale, 0, 0});
  } else if (fs::exists(path / "scene_camera.json", ignored)) {
    add_bop_scene(path, files);
  } else {
    add_plain(images_in(path), options, files);
  }
}

}  // namespace

std::vector<DepthFile> find_depth_files(const std::vector<fs::path>& paths, const DepthFileOptions& options) {
  std::vector<DepthFile> files;
  for (const fs::path& path : paths) {
    const size_t before = files.size();
    add(path, options, files);
    if (files.size() == before) throw InputError::at(path.string(), "depth images", "none");
  }
  for (DepthFile& file : files)
    if (options.depth_scale > 0) file.depth_scale = 1e-3 * options.depth_scale;
  return files;
}

DepthImage read_depth_file(const DepthFile& file) {
  DepthImage image = read_depth_png(file.path, file.depth_scale);
  check_camera(file.camera, file.path.string() + ": its camera", image.width, image.height);
  const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
  if (file.width > 0 && (file.width != image.width || file.height != image.height))
    throw InputError::at(file.path.string(),
                         "an image of " + size(file.width, file.height) + " as --intrinsics says",
                         size(image.width, image.height), "give the intrinsics of this resolution");
  return image;
}

}  // namespace edgepose
