#include "files/uwa_set.h"

#include <algorithm>
#include <map>
#include <set>

#include "common/error.h"
#include "files/mesh_file.h"
#include "files/number_text.h"
#include "files/point_spread.h"
#include "files/rigid_values.h"
#include "files/text_cursor.h"
#include "files/uwa_names.h"
#include "files/whole_file.h"

namespace edgepose {
namespace {

namespace fs = std::filesystem;
constexpr int kDeepest = 3;
constexpr size_t kMostFiles = 100000;  // a home folder given by mistake must not be walked for minutes

struct Listing {
  std::vector<fs::path> truths, plys;
};

Listing list_files(const fs::path& folder) {
  Listing listing;
  std::error_code error;
  const auto options =
      fs::directory_options::follow_directory_symlink | fs::directory_options::skip_permission_denied;
  size_t seen = 0;
  for (fs::recursive_directory_iterator entry(folder, options, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entry.depth() >= kDeepest) entry.disable_recursion_pending();
    const std::string extension = lower_case(entry->path().extension().string());
    if (extension == ".xf") listing.truths.push_back(entry->path());
    if (extension == ".ply") listing.plys.push_back(entry->path());
    if (++seen > kMostFiles) break;
  }
  std::sort(listing.truths.begin(), listing.truths.end());
  std::sort(listing.plys.begin(), listing.plys.end());
  return listing;
}

/// The number a name ends with.
std::optional<int> trailing_number(const std::string& name) {
  const size_t digits = name.find_last_not_of("0123456789") + 1;
  return identifier(std::string_view(name).substr(digits));
}

std::vector<TestObject> number_objects(const std::vector<UwaTruthFile>& files) {
  std::map<std::string, fs::path> meshes;
  for (const UwaTruthFile& file : files) {
    const auto [known, added] = meshes.emplace(file.model.stem().string(), file.model);
    if (!added && known->second != file.model)
      throw InputError::at(file.truth.string(), "one PLY for each model",
                           known->second.string() + " and " + file.model.string());
  }
  std::vector<TestObject> objects;
  for (const auto& [name, mesh] : meshes) {
    TestObject& object = objects.emplace_back();
    object.id = static_cast<int>(objects.size());
    object.name = name;
    object.mesh = mesh;
    object.diameter = largest_spread(read_mesh(mesh, LengthUnit::kMillimetre).vertices);
    if (!(object.diameter > 0))
      throw InputError::at(mesh.string(), "a model with some extent", "all points in one place");
  }
  return objects;
}

std::vector<TestImage> number_images(const std::vector<UwaTruthFile>& files) {
  std::set<fs::path> clouds;
  for (const UwaTruthFile& file : files) clouds.insert(file.scene);
  std::set<int> numbers;
  for (const fs::path& cloud : clouds)
    if (const auto number = trailing_number(cloud.stem().string())) numbers.insert(*number);
  const bool by_name = numbers.size() == clouds.size();
  std::vector<TestImage> images;
  for (const fs::path& cloud : clouds) {
    TestImage& image = images.emplace_back();
    image.scene_id = 1;
    image.image_id = by_name ? *trailing_number(cloud.stem().string()) : static_cast<int>(images.size());
    image.cloud = cloud;
  }
  std::sort(images.begin(), images.end(), [](auto& a, auto& b) { return a.image_id < b.image_id; });
  return images;
}

}  // namespace

bool looks_like_uwa(const fs::path& folder) { return !list_files(folder).truths.empty(); }

RigidTransform parse_xf(std::string_view text, const std::string& name) {
  std::vector<double> values;
  for (const std::string_view token : split_at_blanks(text.substr(0, 4096))) {
    const auto value = finite_number(token);
    if (!value) throw InputError::at(name, "16 numbers, a 4 x 4 matrix row by row", edgepose::quoted(token));
    values.push_back(*value);
  }
  return rigid_from_matrix(values, name);
}

TestSet read_uwa_set(const fs::path& folder) {
  const Listing listing = list_files(folder);
  const std::vector<UwaTruthFile> files = match_uwa_names(listing.truths, listing.plys);
  if (files.empty()) throw InputError::at(folder.string(), "ground truth <object>-<scene>.xf", "none");
  TestSet set;
  set.name = folder_name(folder);
  set.objects = number_objects(files);
  set.images = number_images(files);
  for (const UwaTruthFile& file : files) {
    set.descriptions.push_back(file.truth);
    const auto object = std::find_if(set.objects.begin(), set.objects.end(),
                                     [&](const TestObject& o) { return o.mesh == file.model; });
    const auto image = std::find_if(set.images.begin(), set.images.end(),
                                    [&](const TestImage& i) { return i.cloud == file.scene; });
    GroundTruth& truth = image->truth.emplace_back();
    truth.object_id = object->id;
    truth.camera_T_model =
        parse_xf(read_whole_file(file.truth, "a ground truth (4 x 4 matrix)", 1u << 20), file.truth.string());
  }
  return set;
}

}  // namespace edgepose
