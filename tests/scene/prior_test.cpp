// SPDX-License-Identifier: BSD-3-Clause
#include "scene/prior.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

namespace tactus::scene {
namespace {

using geometry::Vector3;
using support::Rng;

constexpr double pi = std::numbers::pi;

const Prior prior{{0.5, 0.1, -0.2, 0.3, 0.0, 3.0}, {0.0, 0.2, 0.1, 2.0 * pi, 0.4, 1.0}};

TEST(Prior, HoldsItsSamplesAndFillsItsRanges) {
  Rng rng(1);
  Vector3 low = Vector3::Constant(1e300), high = -low;
  for (int i = 0; i < 5000; ++i) {
    const Pose pose = prior.sample(rng);
    ASSERT_TRUE(prior.contains(geometry::pose_vector(pose)));
    low = low.cwiseMin(pose.translation());
    high = high.cwiseMax(pose.translation());
  }
  EXPECT_LT((low - Vector3(0.5, 0.0, -0.25)).cwiseAbs().maxCoeff(), 1e-3);
  EXPECT_LT((high - Vector3(0.5, 0.2, -0.15)).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(Prior, EndsWhereItsWidthsSay) {
  for (std::size_t d = 0; d < 6; ++d)
    for (const double sign : {-1.0, 1.0}) {
      PoseVector v = prior.centre;
      v[d] += sign * 0.5 * prior.width[d];
      EXPECT_TRUE(prior.contains(v)) << d;
      v[d] += sign * 1e-6;
      EXPECT_EQ(prior.contains(v), d == 3) << d;  // a whole turn has no end
      EXPECT_TRUE(prior.contains(v, 1e-5));
    }
}

TEST(Prior, TakesAnglesModuloWholeTurns) {
  PoseVector v = prior.centre;
  v[5] -= 2.0 * pi;
  v[4] += 4.0 * pi;
  EXPECT_TRUE(prior.contains(v));
  v[0] += 2.0 * pi;
  EXPECT_FALSE(prior.contains(v));
}

TEST(Prior, HoldsNoPoseThatIsNotFinite) {
  for (std::size_t d = 0; d < 6; ++d)
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      PoseVector v = prior.centre;
      v[d] = bad;
      EXPECT_FALSE(prior.contains(v)) << d;
    }
}

TEST(Prior, CentralPoseIsThatOfItsCentre) {
  EXPECT_TRUE(prior.central_pose().isApprox(geometry::pose_from(prior.centre)));
}

TEST(NearestAngle, IsTheSameAngleNoMoreThanHalfATurnAway) {
  Rng rng(2);
  for (int i = 0; i < 1000; ++i) {
    const double angle = rng.uniform(-30.0, 30.0), to = rng.uniform(-30.0, 30.0), nearest = nearest_angle(angle, to);
    EXPECT_LE(std::abs(nearest - to), pi + 1e-12);
    EXPECT_NEAR(std::cos(nearest), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(nearest), std::sin(angle), 1e-12);
  }
}

TEST(CellRadius, BoundsTheWayOfEveryPointOfABall) {
  Rng rng(3);
  for (int i = 0; i < 300; ++i) {
    PoseVector centre{}, half{};
    for (std::size_t d = 0; d < 6; ++d) {
      centre[d] = rng.uniform(-3.0, 3.0);
      half[d] = rng.below(3) == 0 ? 0.0 : rng.uniform(0.0, d < 3 ? 0.02 : rng.below(4) == 0 ? 3.2 : 0.3);
    }
    const double reach = rng.uniform(0.0, 0.2), radius = cell_radius(half, reach);
    const Pose about = geometry::pose_from(centre);
    for (int k = 0; k < 50; ++k) {
      PoseVector v = centre;
      for (std::size_t d = 0; d < 6; ++d)
        v[d] += half[d] * (rng.below(2) == 0 ? rng.uniform(-1.0, 1.0) : rng.below(2) == 0 ? -1.0 : 1.0);
      const Vector3 p = reach * Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
      ASSERT_LE((geometry::pose_from(v) * p - about * p).norm(), radius + 1e-12);
    }
  }
}

TEST(CellRadius, OfAPureShiftIsHalfItsDiagonal) {
  EXPECT_DOUBLE_EQ(cell_radius({0.03, 0.04, 0.0, 0.0, 0.0, 0.0}, 1.0), 0.05);
}

}  // namespace
}  // namespace tactus::scene
