#pragma once
#include "matcher/candidate_search.h"
#include "matcher/large_planes.h"
#include "matcher/scene_sampling.h"
#include "tests/matcher/fixtures.h"

namespace edgepose::fixtures {

/// A bracket on the table, seen and sampled: what the stages behind the sampling start from.
struct Sampled {
  explicit Sampled(uint64_t seed, float noise = 0) {
    Random random(seed);
    camera_T_model = pose_on_table(bracket(), table(), random);
    image = render(table(), bracket(), camera_T_model);
    for (float& z : image.depth)
      if (z > 0 && noise > 0) z += noise * static_cast<float>(gaussian(random));
    scene = std::make_unique<Scene>(prepare_scene(image, kCamera));
    const auto d = static_cast<float>(bracket_model().diameter());
    const auto step = static_cast<float>(bracket_model().view().header->sampling_step);
    const auto sampled = sample_scene(scene->data(), step, d, {}, 1);
    for (const SampledPoint& p : drop_large_planes(sampled, d, scene->data().noise, 1))
      points.push_back(p.surface);
  }

  PoseF truth() const {
    return {camera_T_model.linear().cast<float>(), camera_T_model.translation().cast<float>()};
  }
  /// The true pose, turned and moved by as much about the model's centre.
  PoseF perturbed(Random& random, double turn, double shift) const {
    const Eigen::Vector3d centre = bracket_model().centre();
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(turn, random.direction()).toRotationMatrix() * camera_T_model.linear();
    const Eigen::Vector3d at = camera_T_model * centre + shift * random.direction();
    return {rotation.cast<float>(), (at - rotation * centre).cast<float>()};
  }
  /// [m] of the model's centre, and [rad].
  double distance(const PoseF& pose) const {
    const Eigen::Vector3f centre = bracket_model().centre().cast<float>();
    return (pose * centre - truth() * centre).norm();
  }
  double angle(const PoseF& pose) const {
    return Eigen::AngleAxisf(pose.rotation * truth().rotation.transpose()).angle();
  }

  RigidTransform camera_T_model;
  DepthImage image;
  std::unique_ptr<Scene> scene;
  std::vector<OrientedPoint> points;

 private:
  static double gaussian(Random& random) {
    return std::sqrt(-2 * std::log(random.uniform(1e-12, 1))) *
           std::cos(random.uniform(0, 2 * std::numbers::pi));
  }
};

}  // namespace edgepose::fixtures
