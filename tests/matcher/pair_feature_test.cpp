#include "matcher/pair_feature.h"

#include <gtest/gtest.h>

#include "tests/matcher/fixtures.h"

namespace edgepose {
namespace {

TEST(PairFeature, FastAcosIsAsGoodAsItSays) {
  for (int i = -100000; i <= 100000; ++i) {
    const float x = static_cast<float>(i) / 100000;
    ASSERT_NEAR(fast_acos(x), std::acos(x), 7.1e-5f) << x;
  }
  EXPECT_EQ(fast_acos(1.0001f), 0);  // rounding may carry a dot product beyond 1
  EXPECT_NEAR(fast_acos(-1.0001f), std::numbers::pi_v<float>, 1e-6f);
}

TEST(PairFeature, FastAtan2IsAsGoodAsItSays) {
  for (int i = 0; i < 36000; ++i) {
    const double angle = (i - 18000 + 0.5) * std::numbers::pi / 18000;
    for (double radius : {1e-4, 1.0, 300.0}) {
      const auto y = static_cast<float>(radius * std::sin(angle)),
                 x = static_cast<float>(radius * std::cos(angle));
      ASSERT_NEAR(fast_atan2_turns(y, x), std::atan2(y, x) / (2 * std::numbers::pi), 1.01e-5)
          << y << " " << x;
    }
  }
  EXPECT_EQ(fast_atan2_turns(0, 0), 0);
  EXPECT_NEAR(fast_atan2_turns(1, 0), 0.25f, 1e-6f);
  EXPECT_NEAR(fast_atan2_turns(-1, 0), -0.25f, 1e-6f);
  EXPECT_NEAR(fast_atan2_turns(0, -1), 0.5f, 1e-6f);
}

TEST(PairFeature, DoesNotChangeUnderRigidMotions) {
  const FeatureQuantiser unit{1, 1, 1000, 30};
  fixtures::Random random(7);
  for (int i = 0; i < 2000; ++i) {
    const auto point = [&] {
      const Eigen::Vector3d at = random.vector(0.1), normal = random.direction();
      return OrientedPoint{at.cast<float>(), normal.cast<float>()};
    };
    const OrientedPoint a = point(), b = point();
    const float distance = (a.position - b.position).norm();
    if (distance < 0.01f) continue;
    const Eigen::Matrix3f r = random.rotation().cast<float>();
    const Eigen::Vector3f t = random.vector(0.5).cast<float>();
    const OrientedPoint ma{r * a.position + t, r * a.normal}, mb{r * b.position + t, r * b.normal};
    const PairFeature before = unit.feature(a, b, distance),
                      after = unit.feature(ma, mb, (ma.position - mb.position).norm());
    ASSERT_NEAR(before.distance, after.distance, 1e-6f);
    ASSERT_NEAR(before.angle_reference, after.angle_reference, 4e-3f);
    ASSERT_NEAR(before.angle_second, after.angle_second, 4e-3f);
    ASSERT_NEAR(before.angle_normals, after.angle_normals, 4e-3f);
    // And it is Eq. 1: d = p_r - p_s.
    const Eigen::Vector3f d = (a.position - b.position) / distance;
    ASSERT_NEAR(before.angle_reference, std::acos(std::clamp(a.normal.dot(d), -1.f, 1.f)), 1e-3f);
    ASSERT_NEAR(before.angle_second, std::acos(std::clamp(b.normal.dot(d), -1.f, 1.f)), 1e-3f);
  }
}

TEST(PairFeature, AlphaIsTheTurnAboutTheNormal) {
  fixtures::Random random(8);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d normal = random.direction(), at = random.vector(0.1);
    const OrientedPoint reference{at.cast<float>(), normal.cast<float>()};
    const Eigen::Vector3d offset = random.vector(0.1);
    if (offset.cross(normal).norm() < 0.01) continue;
    const double turn = random.uniform(0, 1);
    const Eigen::Vector3d turned = Eigen::AngleAxisd(2 * std::numbers::pi * turn, normal) * offset;
    const ReferenceFrame frame(reference);
    const auto difference =
        static_cast<uint16_t>(frame.alpha((at + turned).cast<float>()) -
                              frame.alpha((at + offset).cast<float>()) - static_cast<int32_t>(turn * 65536));
    ASSERT_LE(std::min<int>(difference, 65536 - difference), 4) << turn;
  }
}

}  // namespace
}  // namespace edgepose
