#pragma once
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "matcher/types.h"
#include "render/overlay.h"

namespace edgepose::internal {

/// An RGB picture of what `camera` sees, with the few drawing steps that overlays need. All lines are
/// anti-aliased; thickness in pixels. Points in the camera frame, metres.
class Canvas {
 public:
  Canvas(const RgbImage& background, const Camera& camera);

  const Camera& camera() const { return camera_; }
  int width() const { return picture_.cols; }
  int height() const { return picture_.rows; }

  /// Where a point appears; nothing if it is behind the camera or far outside the picture.
  std::optional<cv::Point2d> project(const Eigen::Vector3d& point) const;

  /// Lines that are drawn together: where they overlap, a part-transparent colour stays even.
  using Segments = std::vector<std::pair<cv::Point2d, cv::Point2d>>;
  void draw(const Segments& segments, const Colour& colour, double opacity, int thickness);

  /// The same over a dark border that sets it off against any background.
  void draw_outlined(const Segments& segments, const Colour& colour, int thickness);

  /// Mixes `colour` into the pixels for which `mask` is not 0.
  void tint(const cv::Mat& mask, const Colour& colour, double opacity);

  /// Keeps labels away from what must stay visible, as far as there is room elsewhere.
  void keep_clear(const cv::Rect& area) { kept_clear_.push_back(area); }

  /// A box with text, as near to `anchor` as it covers no other label and nothing that is kept clear; a thin
  /// line leads there. Characters other than printable ASCII become '?'.
  void label(const std::string& text, const cv::Point2d& anchor, const Colour& colour, double size);

  RgbImage picture() const;

 private:
  cv::Rect find_place(const cv::Size& box, const cv::Point2d& anchor) const;
  void blend(const cv::Mat& mask, const Colour& colour, double opacity);

  cv::Mat picture_;  // CV_8UC3, red first
  Camera camera_;
  std::vector<cv::Rect> labels_, kept_clear_;
};

}  // namespace edgepose::internal
