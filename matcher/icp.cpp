#include "matcher/icp.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>

namespace edgepose {
namespace {

/// Gauss-Newton sums for a twist (w, v) that moves p to p + w x (p - centre) + v.
class NormalEquations {
 public:
  void add(const Eigen::Vector3f& arm, const Eigen::Vector3f& direction, float residual, float weight) {
    Eigen::Matrix<float, 6, 1> j;
    j << arm.cross(direction), direction;
    const Eigen::Matrix<double, 6, 1> jd = j.cast<double>();
    information_.noalias() += static_cast<double>(weight) * jd * jd.transpose();
    gradient_ += static_cast<double>(weight * residual) * jd;
  }
  /// The step; a small prior keeps directions still that nothing holds (a plane's slide, a cylinder's turn).
  Eigen::Matrix<double, 6, 1> solve(double radius) const {
    Eigen::Matrix<double, 6, 6> damped = information_;
    const double strength = 1e-4 * information_.diagonal().tail<3>().sum();
    damped.diagonal().tail<3>().array() += strength;
    damped.diagonal().head<3>().array() += strength * radius * radius;
    return damped.ldlt().solve(gradient_);
  }
  const Eigen::Matrix<double, 6, 6>& information() const { return information_; }

 private:
  Eigen::Matrix<double, 6, 6> information_ = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Matrix<double, 6, 1> gradient_ = Eigen::Matrix<double, 6, 1>::Zero();
};

/// Pixels from the outline point along `outwards` to where the scene falls away; empty if it does not
/// within `reach` pixels.
std::optional<float> jump_along(const Scene::Data& scene, const PixelProjection& projection,
                                const Eigen::Vector2f& at, const Eigen::Vector2f& outwards, float z,
                                float tolerance, int reach) {
  bool was_inside = false;
  int empty = 0;
  for (int step = -reach; step <= reach; ++step) {
    const Eigen::Vector2f q = at + static_cast<float>(step) * outwards;
    const int64_t pixel = projection.pixel_at(q.x(), q.y());
    if (pixel < 0) return std::nullopt;
    const float depth = scene.depth[pixel];
    if (depth <= 0) {
      ++empty;
      continue;
    }
    if (depth < z - tolerance) {  // an occluder: what follows is its outline, not ours
      was_inside = false;
    } else if (depth < z + tolerance) {
      was_inside = true;
    } else if (was_inside) {
      // A hole of unmeasured pixels hides where exactly the jump is.
      if (empty > 2) return std::nullopt;
      return static_cast<float>(step) - 0.5f - 0.5f * static_cast<float>(empty);
    }
    empty = 0;
  }
  return std::nullopt;
}

struct Iteration {
  NormalEquations equations;
  int count = 0;
  float squares = 0;
};

Iteration accumulate(const Scene::Data& scene, const Model::View& model, const PoseF& pose, size_t view,
                     const Eigen::Vector3f& centre, float max_distance, const IcpOptions& options) {
  Iteration it;
  const PixelProjection projection(scene);
  const float surface_weight = 1 / (options.surface_sigma * options.surface_sigma);
  for_visible_points(model, view, options.max_points, [&](size_t i) {
    const OrientedPoint& m = model.dense_points[i];
    const Eigen::Vector3f p = pose * m.position;
    const int64_t pixel = projection.pixel(p);
    if (pixel < 0) return;
    const Eigen::Vector3f normal = pose.rotation * m.normal;
    const Eigen::Vector3f q = scene.depth[pixel] * projection.ray(pixel);
    const Eigen::Vector3f gap = q - p;
    if (gap.squaredNorm() > 4 * max_distance * max_distance) return;
    const float residual = normal.dot(gap);
    if (std::abs(residual) > max_distance) return;
    const float cosine = normal.dot(scene.normals[pixel]);  // 0 where nothing was fitted
    if (cosine < options.min_normal_cosine) return;
    const float r = residual / max_distance;
    const float tukey = (1 - r * r) * (1 - r * r);
    it.equations.add(p - centre, normal, residual, surface_weight * tukey);
    it.squares += residual * residual;
    ++it.count;
  });
  if (!options.outline) return it;
  for (const ContourPoint& c : model.contour_from(view)) {
    const Eigen::Vector3f p = pose * c.position;
    if (!(p.z() > 1e-3f)) continue;
    const Eigen::Vector3f outwards = pose.rotation * c.outwards;
    const float pixel_size = scene.pixel_size(p.z());
    const Eigen::Vector2f at = projection.project(p),
                          step = projection.project(p + outwards * pixel_size) - at;
    const int reach = std::clamp(static_cast<int>(max_distance / pixel_size), 2, 10);
    const auto jump =
        jump_along(scene, projection, at, step, p.z(), std::max(2 * max_distance, 4 * pixel_size), reach);
    if (!jump) continue;
    const float sigma = options.outline_sigma_pixels * pixel_size;
    const float r = *jump / static_cast<float>(reach + 1);
    it.equations.add(p - centre, outwards, *jump * pixel_size, (1 - r * r) * (1 - r * r) / (sigma * sigma));
  }
  return it;
}

void apply(const Eigen::Matrix<double, 6, 1>& twist, const Eigen::Vector3f& centre, PoseF& pose) {
  const Eigen::Vector3d w = twist.head<3>();
  const double angle = w.norm();
  const Eigen::Matrix3d turn = angle > 1e-12 ? Eigen::AngleAxisd(angle, w / angle).toRotationMatrix()
                                             : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d c = centre.cast<double>();
  pose.translation = (turn * (pose.translation.cast<double>() - c) + c + twist.tail<3>()).cast<float>();
  const Eigen::Quaterniond q(turn * pose.rotation.cast<double>());
  pose.rotation = q.normalized().toRotationMatrix().cast<float>();
}

}  // namespace

IcpResult refine_pose(const Scene::Data& scene, const Model::View& model, const PoseF& start,
                      const IcpOptions& options) {
  IcpResult result;
  result.camera_T_model = start;
  result.surface_sigma = options.surface_sigma;
  const Eigen::Vector3f model_centre = box_centre(*model.header);
  const double radius = model.header->diameter / 4;
  for (int i = 0; i < options.iterations; ++i) {
    const float progress =
        options.iterations > 1 ? static_cast<float>(i) / static_cast<float>(options.iterations - 1) : 1;
    const float max_distance =
        options.max_distance + progress * (options.min_distance - options.max_distance);
    const size_t view = view_of_pose(model, result.camera_T_model, model_centre);
    const Eigen::Vector3f centre = result.camera_T_model * model_centre;
    const Iteration it = accumulate(scene, model, result.camera_T_model, view, centre, max_distance, options);
    result.correspondences = it.count;
    if (it.count < 6) return result;
    result.rms = std::sqrt(it.squares / static_cast<float>(it.count));
    result.information = it.equations.information();
    const Eigen::Matrix<double, 6, 1> twist = it.equations.solve(radius);
    if (!twist.allFinite() || twist.head<3>().norm() > 0.5) return result;
    apply(twist, centre, result.camera_T_model);
    if (progress >= 1 && twist.tail<3>().norm() < 1e-6 && twist.head<3>().norm() < 1e-5) break;
  }
  return result;
}

}  // namespace edgepose
