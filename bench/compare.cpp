/// edgepose_compare: our matcher, OpenCV's surface_matching and PCL's PPFRegistration on the same images.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <set>

#include "bench/comparison.h"
#include "bench/isolated.h"
#include "evaluation/pose_error.h"
#include "evaluation/selection.h"
#include "files/depth_file.h"
#include "files/mesh_file.h"
#include "files/test_set.h"
#include "matcher/scene_data.h"

namespace edgepose::bench {
namespace {

constexpr double kCorrect = 0.05;  // [d]

struct Command {
  std::filesystem::path set;
  std::string images;
  double limit = 60;
  int threads = 1;
  std::vector<std::string> methods = {"edgepose", "opencv", "pcl"};

  void run() const;

 private:
  std::vector<std::unique_ptr<Method>> make_methods() const;
  std::string command_line() const;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Object read_object(const TestObject& object) {
  return {object.id, read_mesh(object.mesh), object.diameter, object.symmetries};
}

/// The measured points with the normals of our own preprocessing, which the peers get for nothing but its
/// time.
Frame read_frame(const TestImage& image, int threads) {
  Frame frame;
  frame.depth = read_depth_png(image.depth, image.depth_scale);
  frame.camera = image.camera;
  const auto start = std::chrono::steady_clock::now();
  SceneOptions options;
  options.threads = threads;
  const Scene scene = prepare_scene(frame.depth, frame.camera, options);
  const Scene::Data& data = scene.data();
  for (int v = 0; v < data.height; ++v) {
    for (int u = 0; u < data.width; ++u) {
      const Eigen::Vector3f& normal = data.normals[data.index(u, v)];
      if (data.depth[data.index(u, v)] > 0 && !normal.isZero())
        frame.points.push_back({data.point(u, v), normal});
    }
  }
  frame.normal_seconds = seconds_since(start);
  return frame;
}

/// [m] to the nearest of the image's instances of the object.
double nearest_error(const PoseError& error, const TestImage& image, int object, const RigidTransform& pose) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const GroundTruth& truth : image.truth) {
    if (truth.object_id == object) nearest = std::min(nearest, error(truth.camera_T_model, pose));
  }
  return nearest;
}

void count(Tally& tally, const Answer& answer, double preprocessing, double error, double diameter) {
  ++tally.asked;
  tally.nothing += answer.outcome == Outcome::kNothing;
  tally.timed_out += answer.outcome == Outcome::kTimedOut;
  tally.crashed += answer.outcome == Outcome::kCrashed;
  if (answer.outcome != Outcome::kCrashed) tally.seconds.push_back(answer.seconds + preprocessing);
  if (answer.outcome == Outcome::kAnswered && error < kCorrect * diameter) {
    ++tally.correct;
    tally.errors.push_back(error);
  }
}

std::vector<std::unique_ptr<Method>> Command::make_methods() const {
  std::vector<std::unique_ptr<Method>> made;
  for (const std::string& name : methods) {
    if (name == "edgepose") made.push_back(edgepose_method(threads));
    if (name == "opencv") made.push_back(opencv_method());
    if (name == "pcl") made.push_back(pcl_method());
  }
  return made;
}

std::string Command::command_line() const {
  std::string text = "edgepose_compare " + set.string();
  if (!images.empty()) text += " --images " + images;
  return text + " --limit " + std::to_string(static_cast<int>(limit)) + " --threads " +
         std::to_string(threads);
}

void Command::run() const {
  Selection selection;
  if (!images.empty()) parse_images(images, selection);
  const TestSet test_set = select(read_test_set(set), selection);
  const auto compared = make_methods();
  std::vector<Tally> tallies;
  for (const auto& method : compared) {
    tallies.emplace_back();
    tallies.back().method = method->name();
    tallies.back().settings = method->settings();
  }

  std::map<int, Object> objects;
  std::map<int, PoseError> errors;
  for (const TestObject& object : test_set.objects) {
    const Object& read = objects.emplace(object.id, read_object(object)).first->second;
    errors.emplace(object.id, PoseError(read.mesh, object.symmetric));
    for (size_t m = 0; m < compared.size(); ++m) {
      std::cerr << "training " << object.name << ": " << compared[m]->name() << '\n';
      const auto start = std::chrono::steady_clock::now();
      compared[m]->train(read);
      tallies[m].train_seconds += seconds_since(start);
      ++tallies[m].objects_trained;
    }
  }

  for (const TestImage& image : test_set.images) {
    const Frame frame = read_frame(image, threads);
    std::set<int> asked;
    for (const GroundTruth& truth : image.truth) {
      if (!asked.insert(truth.object_id).second) continue;
      const Object& object = objects.at(truth.object_id);
      for (size_t m = 0; m < compared.size(); ++m) {
        const Answer answer = ask_isolated(*compared[m], object, frame, limit);
        const double error = nearest_error(errors.at(object.id), image, object.id, answer.camera_T_model);
        const double preprocessing = compared[m]->brings_its_preprocessing() ? 0 : frame.normal_seconds;
        count(tallies[m], answer, preprocessing, error, object.diameter);
        std::cerr << "image " << image.image_id << ", object " << object.id << ", " << compared[m]->name()
                  << ": " << (answer.outcome == Outcome::kAnswered ? 1e3 * error : -1.0) << " mm, "
                  << answer.seconds << " s\n";
      }
    }
  }
  std::cout << test_set.name << ": " << test_set.images.size() << " images, " << threads << " thread(s)\n\n"
            << comparison_table(tallies) << "\nReproduce: " << command_line() << '\n';
}

}  // namespace
}  // namespace edgepose::bench

int main(int argc, char** argv) {
  edgepose::bench::Command command;
  CLI::App app{
      "Compares edgepose with OpenCV's surface_matching and PCL's PPFRegistration on the same images."};
  app.add_option("SET", command.set, "Test set: a BOP folder")->required();
  app.add_option("--images", command.images, "Image numbers, as 0-9 (default: all)");
  app.add_option("--limit", command.limit, "Seconds that a method may take for one object in one image")
      ->check(CLI::Range(1.0, 3600.0));
  app.add_option("--threads", command.threads, "Threads of edgepose; the peers have one")
      ->check(CLI::Range(0, 256));
  app.add_option("--methods", command.methods, "Which to compare")
      ->delimiter(',')
      ->check(CLI::IsMember({"edgepose", "opencv", "pcl"}));
  app.footer("Example:\n  build/bench/bin/edgepose_compare data/range --images 0-4");
  CLI11_PARSE(app, argc, argv);
  try {
    command.run();
  } catch (const std::exception& error) {
    std::cerr << "edgepose_compare: " << error.what() << std::endl;
    return 2;
  }
}
