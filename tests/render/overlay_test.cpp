#include "render/overlay.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>

#include "common/error.h"
#include "render/depth_renderer.h"
#include "tests/render/shapes.h"

namespace edgepose {
namespace {

const Camera kOverlayCamera{300, 300, 79.5, 59.5};
constexpr int kOverlayWidth = 160, kOverlayHeight = 120;
constexpr Colour kGreen{0, 255, 0};

/// A box 4 cm wide before a wall, and if asked a card that hides its right half.
DepthImage scene(const Mesh& box, const RigidTransform& pose, bool half_hidden) {
  DepthRenderer renderer;
  renderer.add(shapes::rectangle(2, 2), shapes::at(0, 0, 0.8));
  renderer.add(box, pose);
  if (half_hidden) renderer.add(shapes::rectangle(0.05f, 0.2f), shapes::at(0.05, 0, 0.3));
  return renderer.render(kOverlayCamera, kOverlayWidth, kOverlayHeight).depth;
}

struct OverlayTest : testing::Test {
  Mesh box = shapes::box(0.02f, 0.015f, 0.01f);
  RigidTransform pose = shapes::at(0, 0, 0.5);

  OverlayPose found() const {
    OverlayPose result;
    result.mesh = &box;
    result.camera_T_model = pose;
    result.colour = kGreen;
    return result;
  }
  static OverlayOptions plain() {
    OverlayOptions options;
    options.width = kOverlayWidth;
    options.zoom = false;
    options.frames = false;
    options.tint = 0;
    return options;
  }
  static std::array<int, 3> at(const RgbImage& image, int u, int v) {
    const size_t i = 3 * (static_cast<size_t>(v) * static_cast<size_t>(image.width) + static_cast<size_t>(u));
    return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
  }
  static int greenness(const RgbImage& image, int u, int v) {
    const auto [r, g, b] = at(image, u, v);
    return g - std::max(r, b);
  }
};

// The front face lies at depth 0.49: u = 79.5 +- 300 * 0.02 / 0.49, v = 59.5 +- 300 * 0.015 / 0.49.
constexpr double kHalfU = 300 * 0.02 / 0.49, kHalfV = 300 * 0.015 / 0.49;

TEST_F(OverlayTest, SilhouetteIsDrawnOnTheProjectedEdges) {
  const RgbImage image = draw_overlay(scene(box, pose, false), kOverlayCamera, {found()}, plain());
  ASSERT_EQ(image.width, kOverlayWidth);
  ASSERT_EQ(image.height, kOverlayHeight);
  for (const double side : {-1.0, 1.0}) {
    EXPECT_GT(greenness(image, static_cast<int>(std::lround(79.5 + side * kHalfU)), 60), 100);
    EXPECT_GT(greenness(image, 80, static_cast<int>(std::lround(59.5 + side * kHalfV))), 100);
  }
  // Nothing inside the face, on the diagonals of its triangles, or away from the box.
  for (int d = -5; d <= 5; ++d) EXPECT_LT(greenness(image, 80 + d, 60 + d * 3 / 4), 20) << d;
  for (int u = 0; u < 60; ++u) EXPECT_LT(greenness(image, u, 60), 20) << u;
}

TEST_F(OverlayTest, LinesHiddenByTheSceneAreFaint) {
  const RgbImage image = draw_overlay(scene(box, pose, true), kOverlayCamera, {found()}, plain());
  const auto strongest = [&](double centre) {
    int best = 0;
    for (int u = static_cast<int>(centre) - 1; u <= static_cast<int>(centre) + 2; ++u) {
      best = std::max(best, greenness(image, u, 60));
    }
    return best;
  };
  EXPECT_GT(strongest(79.5 - kHalfU), 150);
  EXPECT_LT(strongest(79.5 + kHalfU), 120);
  EXPECT_GT(strongest(79.5 + kHalfU), 10);
}

TEST_F(OverlayTest, TintFillsOnlyTheVisibleSurface) {
  OverlayOptions options = plain();
  options.tint = 0.5;
  const RgbImage image = draw_overlay(scene(box, pose, true), kOverlayCamera, {found()}, options);
  EXPECT_GT(greenness(image, 74, 60), 40);
  EXPECT_LT(greenness(image, 86, 60), 20) << "hidden half";
  EXPECT_LT(greenness(image, 20, 60), 20) << "wall";
}

TEST_F(OverlayTest, FrameHasItsAxesInTheirColours) {
  OverlayOptions options = plain();
  options.frames = true;
  options.width = 4 * kOverlayWidth;
  const RgbImage image = draw_overlay(scene(box, pose, false), kOverlayCamera, {found()}, options);
  const double length = 0.15 * 2 * Eigen::Vector3d(0.02, 0.015, 0.01).norm();
  const int reach = static_cast<int>(4 * 300 * length / 0.5 * 0.7), cu = 4 * 80 - 2, cv = 4 * 60 - 2;
  const auto [r, g, b] = at(image, cu + reach, cv);
  EXPECT_GT(r, g + 80) << "x to the right is red";
  const auto [r2, g2, b2] = at(image, cu, cv + reach);
  EXPECT_GT(g2, r2 + 80) << "y down is green";
}

TEST_F(OverlayTest, TargetIsDrawnAtItsEntryPoint) {
  OverlayPose with_target = found();
  with_target.targets.push_back({"", {0.01, 0, -0.01}, {0, 0.5, 1}, 0.01, 0.004});
  const DepthImage depth = scene(box, pose, false);
  const RgbImage without = draw_overlay(depth, kOverlayCamera, {found()}, plain());
  const RgbImage image = draw_overlay(depth, kOverlayCamera, {with_target}, plain());
  const int u = static_cast<int>(std::lround(79.5 + 300 * 0.01 / 0.49));
  const auto [r, g, b] = at(image, u, 60);
  EXPECT_GT(r, b + 60);
  EXPECT_GT(g, b + 60);
  EXPECT_EQ(at(image, u - 12, 60), at(without, u - 12, 60));
}

TEST_F(OverlayTest, LabelIsDrawnBesideTheObject) {
  OverlayOptions options = plain();
  options.width = 8 * kOverlayWidth;
  OverlayPose labelled = found();
  const DepthImage depth = scene(box, pose, false);
  const RgbImage without = draw_overlay(depth, kOverlayCamera, {labelled}, options);
  labelled.label = "box 0.97";
  const RgbImage image = draw_overlay(depth, kOverlayCamera, {labelled}, options);
  int changed = 0;
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      if (at(image, u, v) == at(without, u, v)) continue;
      ++changed;
      EXPECT_FALSE(std::abs(u - 8 * 80) < 8 * kHalfU - 4 && std::abs(v - 8 * 60) < 8 * kHalfV - 4);
      EXPECT_TRUE(std::abs(u - 8 * 80) < 300 && std::abs(v - 8 * 60) < 200) << "far from the object";
    }
  }
  EXPECT_GT(changed, 1000);
}

TEST_F(OverlayTest, ZoomShowsTheObjectLarger) {
  OverlayOptions options = plain();
  const DepthImage depth = scene(box, pose, false);
  options.zoom = true;
  const RgbImage image = draw_overlay(depth, kOverlayCamera, {found()}, options);
  const auto green = [](const RgbImage& picture) {
    int count = 0;
    for (int v = 0; v < picture.height; ++v) {
      for (int u = 0; u < picture.width; ++u) count += greenness(picture, u, v) > 100;
    }
    return count;
  };
  EXPECT_GT(green(image), 1.5 * green(draw_overlay(depth, kOverlayCamera, {found()}, plain())));
}

TEST_F(OverlayTest, SameBitsAtAnyThreadCount) {
  OverlayOptions one, four;
  one.threads = 1;
  four.threads = 4;
  const DepthImage depth = scene(box, pose, true);
  EXPECT_EQ(draw_overlay(depth, kOverlayCamera, {found()}, one).rgb,
            draw_overlay(depth, kOverlayCamera, {found()}, four).rgb);
}

TEST_F(OverlayTest, OddPosesAndTextDoNoHarm) {
  const DepthImage depth = scene(box, pose, false);
  for (const RigidTransform& odd : {shapes::at(0, 0, 0), shapes::at(0, 0, -1), shapes::at(90, 0, 0.1),
                                    shapes::at(0, 0, 1e6), shapes::at(0, 0, 0.011)}) {
    OverlayPose pose_anywhere = found();
    pose_anywhere.camera_T_model = odd;
    pose_anywhere.label = "caf\xc3\xa9\n" + std::string(500, 'x');
    pose_anywhere.targets.push_back({"t", {0, 0, 0}, {0, 0, 1}, 0.01, 0.004});
    EXPECT_GT(draw_overlay(depth, kOverlayCamera, {pose_anywhere}).rgb.size(), 0u);
  }
  EXPECT_GT(draw_overlay({8, 8, std::vector<float>(64, 0.0f)}, kOverlayCamera, {}).rgb.size(), 0u);
}

TEST_F(OverlayTest, RefusesUnsoundInput) {
  DepthImage depth = scene(box, pose, false);
  EXPECT_THROW(draw_overlay(depth, {0, 1, 0, 0}, {}), std::invalid_argument);
  EXPECT_THROW(draw_overlay(depth, kOverlayCamera, {OverlayPose{}}), std::invalid_argument);
  depth.depth.pop_back();
  EXPECT_THROW(draw_overlay(depth, kOverlayCamera, {}), std::invalid_argument);
}

TEST_F(OverlayTest, PngIsWrittenWholeOrNotAtAll) {
  const RgbImage image{2, 1, {255, 0, 0, 0, 0, 255}};
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "overlay_test.png";
  write_png(path, image);
  std::ifstream file(path, std::ios::binary);
  std::string start(8, '\0');
  file.read(start.data(), 8);
  EXPECT_EQ(start, "\x89PNG\r\n\x1a\n");
  EXPECT_THROW(write_png("no_such_folder/x.png", image), InputError);
  EXPECT_THROW(write_png(path, RgbImage{2, 2, {0}}), std::invalid_argument);
}

}  // namespace
}  // namespace edgepose
