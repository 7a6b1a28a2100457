// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <numeric>

#include "robot/kinematics.hpp"
#include "robots.hpp"

namespace tactus::robot {
namespace {

using geometry::Vector3;

Vector3 random_direction(support::Rng& rng) { return Vector3(rng.normal(), rng.normal(), rng.normal()).normalized(); }

/// The farthest that sampled points within reach of the links are from where they were at `a`.
double sampled_motion(const RobotModel& model, const std::vector<double>& reach, const JointVector& a,
                      const JointVector& b, support::Rng& rng) {
  std::vector<Pose> before, after;
  forward(model, a, before);
  forward(model, b, after);
  double farthest = 0.0;
  for (std::size_t i = 0; i < reach.size(); ++i) {
    for (int sample = 0; reach[i] >= 0.0 && sample < 20; ++sample) {
      const Vector3 point = reach[i] * random_direction(rng);
      farthest = std::max(farthest, (after[i] * point - before[i] * point).norm());
    }
  }
  return farthest;
}

class MotionBound : public ::testing::TestWithParam<const char*> {
 protected:
  RobotModel model = testing::load_text(GetParam());
  support::Rng rng{7};

  std::vector<double> random_reach() {
    std::vector<double> reach(model.links.size());
    for (double& r : reach) r = rng.uniform(-0.1, 0.4);
    return reach;
  }
};

TEST_P(MotionBound, NoPointMovesMoreAtTheEndOrOnTheWay) {
  for (int trial = 0; trial < 2000; ++trial) {
    const JointVector from = testing::random_inside(model, rng);
    const double size = std::pow(10.0, rng.uniform(-4.0, 0.0));
    const JointVector to = from + size * (testing::random_inside(model, rng) - from);
    const JointVector between = from + rng.uniform() * (to - from);
    const std::vector<double> reach = random_reach();
    const double bound = motion_bound(model, reach, from, to) * (1.0 + 1e-9) + 1e-12;
    EXPECT_LE(sampled_motion(model, reach, from, to, rng), bound);
    EXPECT_LE(sampled_motion(model, reach, from, between, rng), bound);
    EXPECT_LE(sampled_motion(model, reach, to, between, rng), bound);
  }
}

TEST_P(MotionBound, IsTightForSmallStepsOfOneJoint) {
  const std::vector<double> reach(model.links.size(), 0.0);
  for (int trial = 0; trial < 200; ++trial) {
    const JointVector from = testing::random_inside(model, rng);
    JointVector to = from;
    to[static_cast<int>(rng.below(static_cast<std::uint64_t>(model.dof())))] += 1e-4;
    const double moved = sampled_motion(model, reach, from, to, rng);
    EXPECT_LE(motion_bound(model, reach, from, to), 2.0 * moved + 1e-9);
  }
}

TEST_P(MotionBound, IsSymmetricAndZeroAtRest) {
  const std::vector<double> reach = random_reach();
  const JointVector from = testing::random_inside(model, rng), to = testing::random_inside(model, rng);
  EXPECT_EQ(motion_bound(model, reach, from, from), 0.0);
  EXPECT_DOUBLE_EQ(motion_bound(model, reach, from, to), motion_bound(model, reach, to, from));
}

INSTANTIATE_TEST_SUITE_P(Robots, MotionBound, ::testing::Values(testing::tree_urdf, testing::arm_urdf),
                         [](const auto& robot) { return robot.index == 0 ? "Tree" : "Arm"; });

}  // namespace
}  // namespace tactus::robot
