// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "robot/kinematics.hpp"
#include "robots.hpp"

namespace tactus::robot {
namespace {

using Matrix4 = Eigen::Matrix4d;
using geometry::Vector3;

Matrix4 shift(double x, double y, double z) {
  Matrix4 m = Matrix4::Identity();
  m.col(3) << x, y, z, 1.0;
  return m;
}

Matrix4 turn(const Vector3& axis, double angle) {
  Eigen::Matrix3d k;
  k << 0.0, -axis.z(), axis.y(), axis.z(), 0.0, -axis.x(), -axis.y(), axis.x(), 0.0;
  Matrix4 m = Matrix4::Identity();
  m.topLeftCorner<3, 3>() += std::sin(angle) * k + (1.0 - std::cos(angle)) * k * k;
  return m;
}

Matrix4 rpy(double r, double p, double y) {
  return turn(Vector3::UnitZ(), y) * turn(Vector3::UnitY(), p) * turn(Vector3::UnitX(), r);
}

/// The links of `tree_urdf` written out by hand, in the model's order.
std::vector<Matrix4> tree_by_hand(double shoulder, double rail, double spin) {
  const Matrix4 post = shift(0.1, -0.2, 0.3) * rpy(0.1, 0.2, 0.3);
  const Matrix4 upper = post * shift(0.0, 0.0, 0.1) * rpy(0.0, 1.2, 0.0) * turn({0.0, 0.6, 0.8}, shoulder);
  const Matrix4 slide =
      upper * shift(0.0, 0.05, 0.4) * rpy(-0.4, 0.0, 0.7) * shift(rail * std::sqrt(0.5), 0.0, rail * std::sqrt(0.5));
  const Matrix4 wrist = slide * shift(0.1, 0.0, 0.0) * rpy(0.0, 0.0, 1.0) * turn({0.0, 0.0, -1.0}, spin);
  const Matrix4 follower = wrist * shift(0.0, 0.2, 0.0) * turn({1.0, 0.0, 0.0}, -0.5 * shoulder + 0.3);
  const Matrix4 tip = follower * shift(0.05, 0.06, 0.07) * rpy(0.3, -0.2, 0.9);
  const Matrix4 finger = upper * shift(0.0, 0.0, 0.1) * rpy(1.0, 0.0, 0.0) * shift(0.0, 2.0 * rail, 0.0);
  return {Matrix4::Identity(), post, upper, slide, wrist, follower, tip, finger};
}

TEST(Forward, AgreesWithATreeWrittenOutByHand) {
  const RobotModel model = testing::load_text(testing::tree_urdf);
  support::Rng rng(1);
  std::vector<Pose> poses;
  for (int trial = 0; trial < 200; ++trial) {
    const JointVector q = testing::random_inside(model, rng);
    const std::vector<Matrix4> expected = tree_by_hand(q[0], q[1], q[2]);
    forward(model, q, poses);
    ASSERT_EQ(poses.size(), expected.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_LT((poses[i].matrix() - expected[i]).cwiseAbs().maxCoeff(), 1e-12) << model.links[i].name;
      EXPECT_LT((forward(model, q, static_cast<int>(i)).matrix() - expected[i]).cwiseAbs().maxCoeff(), 1e-12)
          << model.links[i].name;
    }
  }
}

Eigen::MatrixXd by_differences(const RobotModel& model, const JointVector& q, int link, const Pose& tip) {
  constexpr double h = 1e-5;
  Eigen::MatrixXd columns(6, model.dof());
  for (int j = 0; j < model.dof(); ++j) {
    JointVector below = q, above = q;
    below[j] -= h;
    above[j] += h;
    const Pose a = forward(model, below, link) * tip, b = forward(model, above, link) * tip;
    columns.col(j).head<3>() = (b.translation() - a.translation()) / (2.0 * h);
    columns.col(j).tail<3>() = geometry::rotation_vector(b.linear() * a.linear().transpose()) / (2.0 * h);
  }
  return columns;
}

TEST(Jacobian, AgreesWithDifferencesOfForward) {
  support::Rng rng(2);
  const Pose tip = geometry::pose_from({0.1, -0.2, 0.3, 0.4, 0.5, 0.6});
  for (const char* urdf : {testing::tree_urdf, testing::arm_urdf}) {
    const RobotModel model = testing::load_text(urdf);
    for (int trial = 0; trial < 50; ++trial) {
      const JointVector q = testing::random_inside(model, rng);
      for (int link = 0; link < static_cast<int>(model.links.size()); ++link)
        EXPECT_LT((jacobian(model, q, link, tip) - by_differences(model, q, link, tip)).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
}

TEST(InsideLimits, TakesTheLimitsThemselvesAndRefusesNan) {
  const RobotModel model = testing::load_text(testing::tree_urdf);
  EXPECT_TRUE(inside_limits(model, JointVector{{-2.0, 0.3, 1e6}}));
  EXPECT_FALSE(inside_limits(model, JointVector{{-2.1, 0.3, 0.0}}));
  EXPECT_FALSE(inside_limits(model, JointVector{{0.0, std::nan(""), 0.0}}));
}

TEST(Kinematics, RefusesVectorsOfTheWrongSizeAndUnknownLinks) {
  const RobotModel model = testing::load_text(testing::tree_urdf);
  const JointVector q = JointVector::Zero(2);
  EXPECT_THROW(forward(model, q, 0), support::Error);
  EXPECT_THROW(inside_limits(model, q), support::Error);
  EXPECT_THROW(forward(model, JointVector::Zero(3), 8), support::Error);
  EXPECT_THROW(jacobian(model, JointVector::Zero(3), -1), support::Error);
}

}  // namespace
}  // namespace tactus::robot
