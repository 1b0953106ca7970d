#include "render/overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "common/atomic_file.h"
#include "common/error.h"
#include "render/canvas.h"
#include "render/depth_renderer.h"
#include "render/model_lines.h"

namespace edgepose {
namespace {

using Eigen::Vector3d;
using internal::Canvas;

constexpr Colour kPalette[] = {{64, 240, 120},  {255, 150, 40}, {90, 200, 255},
                               {255, 100, 200}, {200, 255, 60}, {190, 140, 255}};
constexpr Colour kTargetColour{255, 222, 40};

/// The scene, the model alone as the renderer sees it, and how much nearer a surface must be to hide a line.
struct PoseView {
  const DepthImage& scene;
  int scale;  // picture pixels in one scene pixel
  DepthImage model;
  double tolerance;  // [m]
};

/// The farthest depth within `reach` pixels of (x, y). `hole` where nothing is measured.
double farthest_around(const DepthImage& image, int x, int y, int reach, double hole) {
  double farthest = 0;
  for (int v = y - reach; v <= y + reach; ++v) {
    for (int u = x - reach; u <= x + reach; ++u) {
      if (u < 0 || v < 0 || u >= image.width || v >= image.height) continue;
      const double depth = image.at(u, v) > 0 ? static_cast<double>(image.at(u, v)) : hole;
      farthest = std::max(farthest, depth);
    }
  }
  return farthest;
}

bool hidden_by_itself(const PoseView& view, const cv::Point2d& at, double depth) {
  const double nothing = std::numeric_limits<double>::infinity();
  const double rendered = farthest_around(view.model, cvRound(at.x), cvRound(at.y), 2, nothing);
  return rendered > 0 && rendered < depth - 0.15 * view.tolerance;
}

bool hidden_by_scene(const PoseView& view, const cv::Point2d& at, double depth) {
  const auto pixel = [&](double x) { return static_cast<int>(std::floor((x + 0.5) / view.scale)); };
  const double seen = farthest_around(view.scene, pixel(at.x), pixel(at.y), 1, 0);
  return seen > 0 && seen < depth - view.tolerance;
}

void draw_lines(Canvas& canvas, const OverlayPose& pose, const PoseView& view, double crease,
                const Colour& colour) {
  Canvas::Segments visible, hidden;
  const Vector3d viewpoint = pose.camera_T_model.inverse().translation();
  for (const internal::LinePiece& piece : internal::model_lines(*pose.mesh, viewpoint, crease)) {
    const Vector3d a = pose.camera_T_model * piece.from, b = pose.camera_T_model * piece.to;
    const auto at_a = canvas.project(a), at_b = canvas.project(b);
    if (!at_a || !at_b) continue;
    const int parts = std::clamp(cvCeil(cv::norm(*at_b - *at_a) / 4), 1, 2000);  // short: each is seen or not
    for (int i = 0; i < parts; ++i) {
      const Vector3d from = a + (b - a) * i / parts, to = a + (b - a) * (i + 1) / parts;
      const Vector3d middle = (from + to) / 2;
      const auto at = canvas.project(middle);
      if (!at || hidden_by_itself(view, *at, middle.z())) continue;
      auto& list = hidden_by_scene(view, *at, middle.z()) ? hidden : visible;
      list.emplace_back(*canvas.project(from), *canvas.project(to));
    }
  }
  canvas.draw(hidden, colour, 0.45, 1);
  canvas.draw_outlined(visible, colour, 2);
}

/// Colours the part of the model that the scene does not hide; returns the silhouette's bounding box.
cv::Rect tint_surface(Canvas& canvas, const PoseView& view, const Colour& colour, double opacity) {
  cv::Mat seen = cv::Mat::zeros(canvas.height(), canvas.width(), CV_8U), silhouette = seen.clone();
  for (int y = 0; y < canvas.height(); ++y) {
    for (int x = 0; x < canvas.width(); ++x) {
      const float depth = view.model.at(x, y);
      if (depth <= 0) continue;
      silhouette.at<uint8_t>(y, x) = 255;
      if (!hidden_by_scene(view, cv::Point2d(x, y), static_cast<double>(depth))) seen.at<uint8_t>(y, x) = 255;
    }
  }
  canvas.tint(seen, colour, opacity);
  return cv::boundingRect(silhouette);
}

void draw_frame(Canvas& canvas, const RigidTransform& camera_T_model, double length) {
  constexpr Colour kAxisColour[] = {{255, 70, 60}, {70, 220, 70}, {90, 130, 255}};
  const auto origin = canvas.project(camera_T_model.translation());
  for (int axis = 0; axis < 3; ++axis) {
    const auto tip = canvas.project(camera_T_model * Vector3d(length * Vector3d::Unit(axis)));
    if (origin && tip) canvas.draw_outlined({{*origin, *tip}}, kAxisColour[axis], 3);
  }
}

void draw_target(Canvas& canvas, const RigidTransform& camera_T_model, const OverlayTarget& target) {
  const Vector3d entry = camera_T_model * target.entry;
  const Vector3d axis = (camera_T_model.linear() * target.axis).normalized();
  const Vector3d outer = entry - 1.2 * target.depth * axis;
  const auto at_entry = canvas.project(entry), at_outer = canvas.project(outer),
             at_tip = canvas.project(entry + target.depth * axis);
  if (!at_entry || !at_outer || !at_tip) return;

  canvas.draw({{*at_entry, *at_tip}}, kTargetColour, 0.55, 1);  // inside the object
  canvas.draw_outlined({{*at_outer, *at_entry}}, kTargetColour, 2);
  const Vector3d across = axis.unitOrthogonal(), third = axis.cross(across);
  Canvas::Segments ring, cross;
  constexpr int kSides = 48;
  const auto on_ring = [&](int i) {
    const double turn = 2 * std::numbers::pi * i / kSides;
    return canvas.project(entry + target.diameter / 2 * (std::cos(turn) * across + std::sin(turn) * third));
  };
  for (int i = 0; i < kSides; ++i) {
    const auto from = on_ring(i), to = on_ring(i + 1);
    if (from && to) ring.emplace_back(*from, *to);
  }
  for (const Vector3d& arm : {across, third}) {
    const auto from = canvas.project(entry - 0.8 * target.diameter * arm),
               to = canvas.project(entry + 0.8 * target.diameter * arm);
    if (from && to) cross.emplace_back(*from, *to);
  }
  canvas.draw_outlined(ring, kTargetColour, 2);
  canvas.draw(cross, kTargetColour, 0.9, 1);
  canvas.label(target.name, *at_outer, kTargetColour, 0.5);
}

/// Diagonal of the bounding box: the size that tolerances and axes go by.
double diagonal(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) box.extend(vertex);
  return box.isEmpty() ? 0 : static_cast<double>(box.diagonal().norm());
}

/// The part of the image that shows the objects and about as much again on every side; all of it if no object
/// can be seen.
cv::Rect surroundings(const DepthImage& image, const Camera& camera, const std::vector<OverlayPose>& poses) {
  double left = image.width, right = 0, top = image.height, bottom = 0;
  for (const OverlayPose& pose : poses) {
    for (const Eigen::Vector3f& vertex : pose.mesh->vertices) {
      const Vector3d p = pose.camera_T_model * vertex.cast<double>();
      if (!(p.z() > 1e-3)) continue;
      const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
      left = std::min(left, u), right = std::max(right, u);
      top = std::min(top, v), bottom = std::max(bottom, v);
    }
  }
  left = std::max(left, 0.0), right = std::min<double>(right, image.width);
  top = std::max(top, 0.0), bottom = std::min<double>(bottom, image.height);
  const cv::Rect all(0, 0, image.width, image.height);
  if (!(left < right && top < bottom)) return all;
  const double aspect = static_cast<double>(image.height) / image.width;
  const double wide = std::max(right - left, (bottom - top) / aspect);
  const int width = std::clamp(cvRound(2.2 * wide), (image.width + 3) / 4, image.width);
  const int height = std::clamp(cvRound(width * aspect), 1, image.height);
  return {std::clamp(cvRound((left + right - width) / 2), 0, image.width - width),
          std::clamp(cvRound((top + bottom - height) / 2), 0, image.height - height), width, height};
}

DepthImage cut(const DepthImage& image, const cv::Rect& part) {
  DepthImage result{part.width, part.height, {}};
  for (int v = part.y; v < part.y + part.height; ++v) {
    const auto row = image.depth.begin() + static_cast<std::ptrdiff_t>(v) * image.width + part.x;
    result.depth.insert(result.depth.end(), row, row + part.width);
  }
  return result;
}

void require_sound(const DepthImage& image, const Camera& camera, const std::vector<OverlayPose>& poses) {
  if (image.width < 1 || image.height < 1 ||
      image.depth.size() != static_cast<size_t>(image.width) * static_cast<size_t>(image.height)) {
    throw std::invalid_argument("depth image: expected width * height values");
  }
  if (!(camera.fx > 0 && camera.fy > 0 && std::isfinite(camera.fx + camera.fy + camera.cx + camera.cy))) {
    throw std::invalid_argument("camera: expected finite numbers with positive fx and fy");
  }
  for (const OverlayPose& pose : poses) {
    if (pose.mesh == nullptr) throw std::invalid_argument("overlay: a pose has no mesh");
  }
}

/// Pixel centres are at whole numbers: (u, v) of the image is ((u + 0.5) * scale - 0.5) of the picture.
Camera enlarged_by(int scale, const Camera& camera) {
  return {camera.fx * scale, camera.fy * scale, (camera.cx + 0.5) * scale - 0.5,
          (camera.cy + 0.5) * scale - 0.5};
}

/// Last of all, so that nothing is drawn over what is read. `boxes` are where the poses are seen.
void draw_notes(Canvas& canvas, const std::vector<OverlayPose>& poses, const std::vector<cv::Rect>& boxes,
                const std::vector<Colour>& colours) {
  for (const cv::Rect& box : boxes) canvas.keep_clear(box);
  for (const OverlayPose& pose : poses)
    for (const OverlayTarget& target : pose.targets) draw_target(canvas, pose.camera_T_model, target);
  for (size_t i = 0; i < poses.size(); ++i) {
    canvas.label(poses[i].label, cv::Point2d(boxes[i].x + boxes[i].width / 2.0, boxes[i].y), colours[i],
                 0.65);
  }
}

std::vector<Colour> colours_of(const std::vector<OverlayPose>& poses) {
  std::vector<Colour> colours;
  for (size_t i = 0; i < poses.size(); ++i)
    colours.push_back(poses[i].colour == Colour{0, 0, 0} ? kPalette[i % std::size(kPalette)]
                                                         : poses[i].colour);
  return colours;
}

/// Where the vertices appear in the picture.
cv::Rect bounding_box(const Canvas& canvas, const OverlayPose& pose) {
  cv::Rect box;
  for (const Eigen::Vector3f& vertex : pose.mesh->vertices)
    if (const auto at = canvas.project(pose.camera_T_model * vertex.cast<double>()))
      box |= cv::Rect(cvRound(at->x), cvRound(at->y), 1, 1);
  return box & cv::Rect(0, 0, canvas.width(), canvas.height());
}

}  // namespace

void annotate_overlay(RgbImage& picture, const DepthImage& image, const Camera& camera,
                      const std::vector<OverlayPose>& poses, const OverlayOptions& options) {
  require_sound(image, camera, poses);
  Canvas canvas(picture, enlarged_by(picture.width / image.width, camera));
  std::vector<cv::Rect> boxes;
  for (const OverlayPose& pose : poses) {
    boxes.push_back(bounding_box(canvas, pose));
    if (options.frames) draw_frame(canvas, pose.camera_T_model, 0.15 * diagonal(*pose.mesh));
  }
  draw_notes(canvas, poses, boxes, colours_of(poses));
  picture = canvas.picture();
}

RgbImage draw_overlay(const DepthImage& whole_image, const Camera& whole_camera,
                      const std::vector<OverlayPose>& poses, const OverlayOptions& options) {
  require_sound(whole_image, whole_camera, poses);
  const cv::Rect part = options.zoom ? surroundings(whole_image, whole_camera, poses)
                                     : cv::Rect(0, 0, whole_image.width, whole_image.height);
  const DepthImage image = cut(whole_image, part);
  Camera camera = whole_camera;
  camera.cx -= part.x;
  camera.cy -= part.y;
  const int scale =
      std::clamp(static_cast<int>(std::lround(static_cast<double>(options.width) / image.width)), 1, 8);
  const Camera enlarged = enlarged_by(scale, camera);
  Canvas canvas(shade_depth(image, camera, scale), enlarged);

  std::vector<cv::Rect> boxes(poses.size());
  const std::vector<Colour> colours = colours_of(poses);
  for (size_t i = 0; i < poses.size(); ++i) {
    const OverlayPose& pose = poses[i];
    DepthRenderer renderer;
    renderer.add(*pose.mesh, pose.camera_T_model);
    const double size = diagonal(*pose.mesh);
    const PoseView view{image, scale,
                        renderer.render(enlarged, canvas.width(), canvas.height(), options.threads).depth,
                        std::max(0.003, 0.03 * size)};
    boxes[i] = tint_surface(canvas, view, colours[i], options.tint);
    draw_lines(canvas, pose, view, options.crease_angle_deg * std::numbers::pi / 180, colours[i]);
    if (options.frames) draw_frame(canvas, pose.camera_T_model, 0.15 * size);
  }
  draw_notes(canvas, poses, boxes, colours);
  return canvas.picture();
}

std::vector<std::byte> encode_png(const RgbImage& image) {
  const size_t expected = 3 * static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (image.width < 1 || image.height < 1 || image.rgb.size() != expected) {
    throw std::invalid_argument("picture: expected 3 * width * height values");
  }
  const cv::Mat rgb(image.height, image.width, CV_8UC3, const_cast<uint8_t*>(image.rgb.data()));
  cv::Mat bgr;
  cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
  std::vector<uint8_t> png;
  if (!cv::imencode(".png", bgr, png)) throw std::runtime_error("the picture cannot be coded as PNG");
  const auto bytes = std::as_bytes(std::span(png));
  return {bytes.begin(), bytes.end()};
}

void write_png(const std::filesystem::path& path, const RgbImage& image) {
  write_file_atomically(path, encode_png(image));
}

}  // namespace edgepose
