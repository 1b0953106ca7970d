#include "matcher/icp.h"

#include <algorithm>
#include <array>
#include <optional>

#include "matcher/wide_simd.h"

namespace edgepose {
namespace {

constexpr int kMaxReach = 10;  // pixels to either side of the outline that are looked at

/// A short line of pixels through an outline point, from inside of the model outwards.
class PixelLine {
 public:
  /// `step`: one pixel outwards. If the line leaves the image, `depth()` must not be called.
  PixelLine(const Scene::Data& scene, const PixelProjection& projection, const Eigen::Vector2f& middle,
            const Eigen::Vector2f& step, int reach)
      : scene_(scene), middle_(middle), step_(step) {
    const float ends = static_cast<float>(reach);
    const Eigen::Vector2f first = middle - ends * step, last = middle + ends * step;
    // A line's ends are inside of the image if, and only if, all of it is.
    inside_ = projection.pixel_at(first.x(), first.y()) >= 0 && projection.pixel_at(last.x(), last.y()) >= 0;
  }
  bool inside() const { return inside_; }
  /// [m] what the scene has so many pixels outwards.
  float depth(int outwards) const {
    const float along = static_cast<float>(outwards);
    const float x = middle_.x() + along * step_.x() + 0.5f, y = middle_.y() + along * step_.y() + 0.5f;
    const auto u = static_cast<size_t>(x), v = static_cast<size_t>(y);
    return scene_.depth[v * static_cast<size_t>(scene_.width) + u];
  }

 private:
  const Scene::Data& scene_;
  const Eigen::Vector2f middle_, step_;
  bool inside_;
};

/// Pixels from the outline point along the line to where the scene falls away; empty if it does not.
std::optional<float> jump_along(const PixelLine& line, float z, float tolerance, int reach) {
  bool was_inside = false;
  int empty = 0;
  for (int k = -reach; k <= reach; ++k) {
    const float depth = line.depth(k);
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
      return static_cast<float>(k) - 0.5f - 0.5f * static_cast<float>(empty);
    }
    empty = 0;
  }
  return std::nullopt;
}

/// Where correspondences are looked for.
struct SurfaceReach {
  float centre_x, centre_y, centre_z;  // [m] that the twist turns about
  float max_distance;                  // [m]
  float min_cosine;                    // of the angle between the normals
  float weight;                        // of a residual of 0
};

struct SurfaceColumns {
  const float *x, *y, *z, *nx, *ny, *nz, *ray_x, *ray_y;       // of the model
  const float *depth, *scene_nx, *scene_ny, *scene_nz;         // of the scene; no depth, no normal: 0
  float *arm_x, *arm_y, *arm_z, *residual, *weight, *counted;  // of the rows; counted: 0 or 1
};

/// Point to plane, for all points side by side; Tukey's weights.
EDGEPOSE_WIDE_SIMD void compare_surface(SurfaceColumns c, size_t count, SurfaceReach reach) {
  EDGEPOSE_NO_OVERLAP
  for (size_t i = 0; i < count; ++i) {
    const float gx = c.depth[i] * c.ray_x[i] - c.x[i], gy = c.depth[i] * c.ray_y[i] - c.y[i],
                gz = c.depth[i] - c.z[i];
    const float residual = c.nx[i] * gx + c.ny[i] * gy + c.nz[i] * gz;
    const float cosine = c.nx[i] * c.scene_nx[i] + c.ny[i] * c.scene_ny[i] + c.nz[i] * c.scene_nz[i];
    const float squared = gx * gx + gy * gy + gz * gz, limit = reach.max_distance;
    float counted = squared <= 4 * limit * limit ? 1.f : 0.f;
    counted = std::abs(residual) <= limit ? counted : 0.f;
    counted = cosine >= reach.min_cosine ? counted : 0.f;
    const float r = residual / limit;
    const float tukey = (1 - r * r) * (1 - r * r);
    c.arm_x[i] = c.x[i] - reach.centre_x;
    c.arm_y[i] = c.y[i] - reach.centre_y;
    c.arm_z[i] = c.z[i] - reach.centre_z;
    c.residual[i] = residual;
    c.weight[i] = counted > 0 ? reach.weight * tukey : 0.f;
    c.counted[i] = counted;
  }
}

/// Reads the scene at the points' pixels.
void read_scene(const Scene::Data& scene, PoseWorkspace& work) {
  const size_t count = work.surface.padded();
  for (auto* column : {&work.depth, &work.nx, &work.ny, &work.nz, &work.counted}) column->resize(count);
  for (size_t i = 0; i < count; ++i) {
    const int32_t pixel = work.surface.pixel[i];
    const bool there = pixel >= 0;
    const Eigen::Vector3f& normal = scene.normals[there ? static_cast<size_t>(pixel) : 0];
    const float depth = scene.depth[there ? static_cast<size_t>(pixel) : 0];
    work.depth[i] = there ? depth : 0.f;
    work.nx[i] = there ? normal.x() : 0.f, work.ny[i] = there ? normal.y() : 0.f;
    work.nz[i] = there ? normal.z() : 0.f;
  }
}

struct Fit {
  int count = 0;      ///< surface correspondences
  float squares = 0;  ///< [m^2] sum over their residuals
};

/// Fills the rows with the surface's correspondences.
Fit add_surface(const Scene::Data& scene, const PoseF& pose, const Eigen::Vector3f& centre,
                float max_distance, const IcpOptions& options, PoseWorkspace& work) {
  const PixelProjection projection(scene);
  PosedSurface& s = work.surface;
  s.place(pose, projection);
  read_scene(scene, work);
  ResidualRows& rows = work.rows;
  rows.resize(s.padded());
  compare_surface(
      {s.x.data(), s.y.data(), s.z.data(), s.nx.data(), s.ny.data(), s.nz.data(), s.ray_x.data(),
       s.ray_y.data(), work.depth.data(), work.nx.data(), work.ny.data(), work.nz.data(), rows.arm_x.data(),
       rows.arm_y.data(), rows.arm_z.data(), rows.residual.data(), rows.weight.data(), work.counted.data()},
      s.padded(),
      {centre.x(), centre.y(), centre.z(), max_distance, options.min_normal_cosine,
       1 / (options.surface_sigma * options.surface_sigma)});
  std::copy(s.nx.begin(), s.nx.end(), rows.dir_x.begin());
  std::copy(s.ny.begin(), s.ny.end(), rows.dir_y.begin());
  std::copy(s.nz.begin(), s.nz.end(), rows.dir_z.begin());
  Fit fit;
  for (size_t i = 0; i < s.count(); ++i) {
    fit.count += work.counted[i] > 0;
    fit.squares += work.counted[i] > 0 ? rows.residual[i] * rows.residual[i] : 0.f;
  }
  return fit;
}

/// Adds what pulls the outline to the scene's depth jumps.
void add_outline(const Scene::Data& scene, const Model::View& model, const PoseF& pose, size_t view,
                 const Eigen::Vector3f& centre, float max_distance, const IcpOptions& options,
                 ResidualRows& rows) {
  const PixelProjection projection(scene);
  const auto contour = model.contour_from(view);
  const auto stride = static_cast<size_t>(options.outline_stride);
  for (size_t i = 0; i < contour.size(); i += stride) {
    const ContourPoint& c = contour[i];
    const Eigen::Vector3f p = pose * c.position;
    if (!(p.z() > 1e-3f)) continue;
    const Eigen::Vector3f outwards = pose.rotation * c.outwards;
    const float pixel_size = scene.pixel_size(p.z());
    const Eigen::Vector2f at = projection.project(p),
                          step = projection.project(p + outwards * pixel_size) - at;
    const int reach = std::clamp(static_cast<int>(max_distance / pixel_size), 2, kMaxReach);
    const PixelLine line(scene, projection, at, step, reach);
    if (!line.inside()) continue;
    const auto jump = jump_along(line, p.z(), std::max(2 * max_distance, 4 * pixel_size), reach);
    if (!jump) continue;
    const float sigma = options.outline_sigma_pixels * pixel_size;
    const float r = *jump / static_cast<float>(reach + 1);
    rows.append(p - centre, outwards, *jump * pixel_size,
                static_cast<float>(stride) * (1 - r * r) * (1 - r * r) / (sigma * sigma));
  }
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
                      const IcpOptions& options, PoseWorkspace& work) {
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
    PoseF& pose = result.camera_T_model;
    const size_t view = view_of_pose(model, pose, model_centre);
    const Eigen::Vector3f centre = pose * model_centre;
    work.surface.take(model, view, options.max_points);
    const Fit fit = add_surface(scene, pose, centre, max_distance, options, work);
    result.correspondences = fit.count;
    if (fit.count < 6) return result;
    if (options.outline) add_outline(scene, model, pose, view, centre, max_distance, options, work.rows);
    const NormalEquations equations(work.rows);
    result.rms = std::sqrt(fit.squares / static_cast<float>(fit.count));
    result.information = equations.information;
    const Eigen::Matrix<double, 6, 1> twist = equations.solve(radius);
    if (!twist.allFinite() || twist.head<3>().norm() > 0.5) return result;
    apply(twist, centre, pose);
    if (progress >= 1 && twist.tail<3>().norm() < 1e-6 && twist.head<3>().norm() < 1e-5) break;
  }
  return result;
}

}  // namespace edgepose
