#include "render/canvas.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace edgepose::internal {
namespace {

constexpr int kShift = 4;  // sub-pixel bits of OpenCV's line coordinates
constexpr Colour kDark{12, 13, 16}, kLight{245, 245, 245};

cv::Point fixed(const cv::Point2d& point) {
  return {cvRound(point.x * (1 << kShift)), cvRound(point.y * (1 << kShift))};
}

std::string printable(std::string text) {
  for (char& c : text) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text.substr(0, 80);
}

}  // namespace

Canvas::Canvas(const RgbImage& background, const Camera& camera)
    : picture_(background.height, background.width, CV_8UC3), camera_(camera) {
  std::copy(background.rgb.begin(), background.rgb.end(), picture_.data);
}

std::optional<cv::Point2d> Canvas::project(const Eigen::Vector3d& point) const {
  if (point.z() < 1e-3) return std::nullopt;
  const cv::Point2d at(camera_.fx * point.x() / point.z() + camera_.cx,
                       camera_.fy * point.y() / point.z() + camera_.cy);
  const double reach = 4.0 * std::max(width(), height());
  if (!(std::abs(at.x) < reach && std::abs(at.y) < reach)) return std::nullopt;
  return at;
}

void Canvas::draw(const Segments& segments, const Colour& colour, double opacity, int thickness) {
  if (segments.empty()) return;
  cv::Mat mask = cv::Mat::zeros(picture_.size(), CV_8U);
  for (const auto& [from, to] : segments) {
    cv::line(mask, fixed(from), fixed(to), cv::Scalar(255), thickness, cv::LINE_AA, kShift);
  }
  blend(mask, colour, opacity);
}

void Canvas::draw_outlined(const Segments& segments, const Colour& colour, int thickness) {
  draw(segments, kDark, 0.6, thickness + 2);
  draw(segments, colour, 1, thickness);
}

void Canvas::tint(const cv::Mat& mask, const Colour& colour, double opacity) { blend(mask, colour, opacity); }

void Canvas::blend(const cv::Mat& mask, const Colour& colour, double opacity) {
  for (int y = 0; y < picture_.rows; ++y) {
    for (int x = 0; x < picture_.cols; ++x) {
      const double share = opacity * mask.at<uint8_t>(y, x) / 255;
      if (share == 0) continue;
      auto& pixel = picture_.at<cv::Vec3b>(y, x);
      for (int c = 0; c < 3; ++c) {
        pixel[c] =
            cv::saturate_cast<uint8_t>((1 - share) * pixel[c] + share * colour[static_cast<size_t>(c)]);
      }
    }
  }
}

cv::Rect Canvas::find_place(const cv::Size& box, const cv::Point2d& anchor) const {
  const auto overlaps = [](const std::vector<cv::Rect>& others, const cv::Rect& rect) {
    return std::any_of(others.begin(), others.end(),
                       [&](const cv::Rect& other) { return (other & rect).area() > 0; });
  };
  const auto place = [&](double dx, double dy) {
    return cv::Rect(
        std::clamp(cvRound(anchor.x + dx) - box.width / 2, 0, std::max(0, width() - box.width)),
        std::clamp(cvRound(anchor.y + dy) - box.height / 2, 0, std::max(0, height() - box.height)), box.width,
        box.height);
  };
  // Rings of growing size about the anchor, wider than high as the boxes are, upwards first.
  for (const bool may_cover : {false, true}) {
    for (int ring = 0; ring < 40; ++ring) {
      for (int turn = 0; turn < 24; ++turn) {
        const int half = (turn + 1) / 2 * (turn % 2 ? 1 : -1);
        const double angle = half * std::numbers::pi / 12 - std::numbers::pi / 2;
        const int across = box.width / 2 + 12 * ring, along = box.height + 12 * ring;
        const cv::Rect rect = place(across * std::cos(angle), along * std::sin(angle));
        if (!overlaps(labels_, rect) && (may_cover || !overlaps(kept_clear_, rect))) return rect;
      }
    }
  }
  return place(0, 0);
}

void Canvas::label(const std::string& text, const cv::Point2d& anchor, const Colour& colour, double size) {
  if (text.empty()) return;
  const std::string shown = printable(text);
  const int font = cv::FONT_HERSHEY_SIMPLEX, margin = cvRound(size * 12), bar = 5;
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(shown, font, size, 1, &baseline);
  const cv::Rect rect =
      find_place({extent.width + 2 * margin + bar, extent.height + baseline + margin}, anchor);
  labels_.push_back(rect);

  const cv::Point2d nearest(std::clamp(anchor.x, double(rect.x), double(rect.x + rect.width)),
                            std::clamp(anchor.y, double(rect.y), double(rect.y + rect.height)));
  if (cv::norm(nearest - anchor) > 10) draw({{nearest, anchor}}, colour, 0.6, 1);
  cv::Mat mask = cv::Mat::zeros(picture_.size(), CV_8U);
  cv::rectangle(mask, rect, cv::Scalar(255), cv::FILLED);
  blend(mask, kDark, 0.78);
  mask.setTo(0);
  cv::rectangle(mask, cv::Rect(rect.x, rect.y, bar, rect.height), cv::Scalar(255), cv::FILLED);
  blend(mask, colour, 1);
  mask.setTo(0);
  cv::putText(mask, shown, {rect.x + bar + margin, rect.y + margin / 2 + extent.height}, font, size,
              cv::Scalar(255), 1, cv::LINE_AA);
  blend(mask, kLight, 1);
}

RgbImage Canvas::picture() const {
  RgbImage result{picture_.cols, picture_.rows, {}};
  result.rgb.assign(picture_.datastart, picture_.dataend);
  return result;
}

}  // namespace edgepose::internal
