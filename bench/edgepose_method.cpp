#include <map>

#include "bench/method.h"

namespace edgepose::bench {
namespace {

class Edgepose : public Method {
 public:
  explicit Edgepose(int threads) {
    train_.threads = threads;
    scene_.threads = threads;
    match_.threads = threads;
  }

  std::string name() const override { return "edgepose"; }
  std::string settings() const override {
    return "defaults, " + std::to_string(match_.threads) + " thread(s)";
  }
  bool brings_its_preprocessing() const override { return true; }

  void train(const Object& object) override {
    models_.insert_or_assign(object.id,
                             train_model(object.mesh, std::to_string(object.id), train_, object.symmetries));
  }

  std::optional<RigidTransform> find(const Object& object, const Frame& frame) override {
    const Scene scene = prepare_scene(frame.depth, frame.camera, scene_);
    const MatchResult result = match(scene, models_.at(object.id), match_);
    // The peers cannot say "not here": the best guess counts for ours, too.
    if (result.detections.empty()) return std::nullopt;
    return result.detections.front().camera_T_model;
  }

 private:
  TrainOptions train_;
  SceneOptions scene_;
  MatchOptions match_;
  std::map<int, Model> models_;
};

}  // namespace

std::unique_ptr<Method> edgepose_method(int threads) { return std::make_unique<Edgepose>(threads); }

}  // namespace edgepose::bench
