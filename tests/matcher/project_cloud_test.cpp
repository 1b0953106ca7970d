#include <gtest/gtest.h>

#include <stdexcept>

#include "matcher/scene_data.h"
#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

TEST(ProjectCloud, PlaneComesBack) {
  fixtures::Random random(3);
  const Eigen::Matrix3d world = random.rotation();
  const Eigen::Vector3d viewpoint(0.3, -0.1, 0.7);
  const Eigen::Vector3d normal = world * Eigen::Vector3d(0.2, 0.1, -1).normalized();
  const Eigen::Vector3d middle = viewpoint + world * Eigen::Vector3d(0, 0, 1);
  const Eigen::Vector3d x = normal.unitOrthogonal(), y = normal.cross(x);
  std::vector<Eigen::Vector3f> points;
  for (int i = -100; i <= 100; ++i)
    for (int k = -100; k <= 100; ++k) points.push_back((middle + 0.002 * (i * x + k * y)).cast<float>());
  points.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.f, 0.f);
  const auto projected = project_cloud(points, viewpoint.cast<float>());
  EXPECT_LT((projected.cloud_T_camera.translation() - viewpoint).norm(), 1e-6);
  EXPECT_NEAR(projected.cloud_T_camera.linear().determinant(), 1, 1e-9);
  EXPECT_GT(projected.cloud_T_camera.linear().col(2).dot((middle - viewpoint).normalized()), 0.999);

  const Scene scene = prepare_scene(projected.image, projected.camera);
  const Scene::Data& data = scene.data();
  size_t measured = 0;
  for (int v = 0; v < data.height; ++v)
    for (int u = 0; u < data.width; ++u) {
      if (data.depth[data.index(u, v)] <= 0) continue;
      ++measured;
      const Eigen::Vector3d p = projected.cloud_T_camera * data.point(u, v).cast<double>();
      ASSERT_LT(std::abs(normal.dot(p - middle)), data.pixel_size(1)) << u << " " << v;
    }
  EXPECT_GT(measured, points.size() / 2);
  const Eigen::Vector3f& seen = data.normals[data.index(data.width / 2, data.height / 2)];
  const Eigen::Vector3d turned = projected.cloud_T_camera.linear() * seen.cast<double>();
  EXPECT_GT(turned.dot(normal), std::cos(0.05));
}

TEST(ProjectCloud, RefusesTooFewPoints) {
  EXPECT_THROW(project_cloud({}), std::invalid_argument);
  std::vector<Eigen::Vector3f> points(99, Eigen::Vector3f(0, 0, 1));
  EXPECT_THROW(project_cloud(points), std::invalid_argument);
  points.resize(500, Eigen::Vector3f::Constant(std::numeric_limits<float>::infinity()));
  EXPECT_THROW(project_cloud(points), std::invalid_argument) << "infinite points count";
}

TEST(ProjectCloud, RefusesAViewpointInTheMiddle) {
  const std::vector<Eigen::Vector3f> points(200, Eigen::Vector3f(0, 0, 1));
  EXPECT_THROW(project_cloud(points, {0, 0, 1}), std::invalid_argument);
}

}  // namespace
}  // namespace edgepose
