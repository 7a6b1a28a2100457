// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/pose.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/rng.hpp"

namespace tactus::geometry {
namespace {

using support::Rng;

constexpr double pi = std::numbers::pi;

Pose random_pose(Rng& rng) {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond(rng.normal(), rng.normal(), rng.normal(), rng.normal()).normalized().toRotationMatrix();
  pose.translation() = Vector3(rng.normal(), rng.normal(), rng.normal());
  return pose;
}

TEST(Pose, RollPitchYawTurnAboutTheFixedAxesInThisOrder) {
  const Pose pose = pose_from({1.0, 2.0, 3.0, 0.5 * pi, 0.0, 0.5 * pi});
  EXPECT_TRUE(pose.translation().isApprox(Vector3(1.0, 2.0, 3.0)));
  EXPECT_TRUE((pose.linear() * Vector3::UnitX()).isApprox(Vector3::UnitY(), 1e-12));
  EXPECT_TRUE((pose.linear() * Vector3::UnitY()).isApprox(Vector3::UnitZ(), 1e-12));
  EXPECT_TRUE((pose_from({0, 0, 0, 0, 0.5 * pi, 0}).linear() * Vector3::UnitX()).isApprox(-Vector3::UnitZ(), 1e-12));
}

TEST(Pose, NumbersAndPoseGiveOneAnother) {
  Rng rng(1);
  for (int i = 0; i < 2000; ++i) {
    const Pose pose = random_pose(rng);
    const PoseVector v = pose_vector(pose);
    EXPECT_LT((pose_from(v).matrix() - pose.matrix()).cwiseAbs().maxCoeff(), 1e-9);
    for (const std::size_t d : {3u, 5u}) EXPECT_LE(std::abs(v[d]), pi);
    EXPECT_LE(std::abs(v[4]), 0.5 * pi);
  }
}

TEST(Pose, NumbersAtAQuarterTurnOfPitchStillGiveThePose) {
  Rng rng(2);
  for (const double pitch : {0.5 * pi, -0.5 * pi})
    for (const double off : {0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-9, 1e-7, 1e-5})
      for (int i = 0; i < 100; ++i) {
        const Pose pose =
            pose_from({0, 0, 0, rng.uniform(-pi, pi), pitch - std::copysign(off, pitch), rng.uniform(-pi, pi)});
        EXPECT_LT((pose_from(pose_vector(pose)).matrix() - pose.matrix()).cwiseAbs().maxCoeff(), 1e-11) << off;
      }
}

TEST(Pose, QuaternionsComeBackAndNeedNotBeOfUnitLength) {
  Rng rng(3);
  for (int i = 0; i < 500; ++i) {
    const Pose pose = random_pose(rng);
    double v[7];
    to_quaternion(pose, v);
    EXPECT_NEAR(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6], 1.0, 1e-12);
    EXPECT_TRUE(pose_from_quaternion(v).isApprox(pose, 1e-12));
    const double scale = rng.uniform(-3.0, 3.0);
    for (int k = 3; k < 7; ++k) v[k] *= scale;
    EXPECT_TRUE(pose_from_quaternion(v).isApprox(pose, 1e-9));
  }
}

TEST(Pose, QuaternionsHaveTheRealPartLast) {
  const double v[7] = {0, 0, 0, 1, 0, 0, 0};
  EXPECT_TRUE((pose_from_quaternion(v).linear() * Vector3::UnitY()).isApprox(-Vector3::UnitY()));
}

TEST(AngleBetween, IsThatOfTheTurn) {
  Rng rng(4);
  for (int i = 0; i < 500; ++i) {
    const Pose from = random_pose(rng);
    const double angle = i % 3 == 0   ? rng.uniform(0.0, pi)
                         : i % 3 == 1 ? 1e-9 * rng.uniform()
                                      : pi - 1e-9 * rng.uniform();
    const Vector3 axis = Vector3(rng.normal(), rng.normal(), rng.normal()).normalized();
    const Pose to = from * Eigen::AngleAxisd(angle, axis);
    EXPECT_NEAR(angle_between(from, to), angle, 3e-8);
    EXPECT_NEAR(angle_between(to, from), angle, 3e-8);
  }
}

TEST(RotationVector, TurnsBack) {
  Rng rng(5);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Matrix3d rotation = random_pose(rng).linear();
    const Vector3 v = rotation_vector(rotation);
    EXPECT_LE(v.norm(), pi + 1e-12);
    EXPECT_TRUE(Eigen::AngleAxisd(v.norm(), v.normalized()).toRotationMatrix().isApprox(rotation, 1e-9));
  }
  EXPECT_EQ(rotation_vector(Eigen::Matrix3d::Identity()).norm(), 0.0);
}

TEST(Interpolate, GoesStraightAndTurnsEvenly) {
  Rng rng(6);
  for (int i = 0; i < 200; ++i) {
    const Pose from = random_pose(rng), to = random_pose(rng);
    const double fraction = rng.uniform(), whole = angle_between(from, to);
    const Pose between = interpolate(from, to, fraction);
    EXPECT_TRUE(between.translation().isApprox((1.0 - fraction) * from.translation() + fraction * to.translation()));
    EXPECT_NEAR(angle_between(from, between), fraction * whole, 1e-7);
    EXPECT_NEAR(angle_between(between, to), (1.0 - fraction) * whole, 1e-7);
    EXPECT_TRUE(interpolate(from, to, 0.0).isApprox(from, 1e-9));
    EXPECT_TRUE(interpolate(from, to, 1.0).isApprox(to, 1e-9));
  }
}

}  // namespace
}  // namespace tactus::geometry
