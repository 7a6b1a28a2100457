// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "robot/kinematics.hpp"
#include "robots.hpp"

namespace tactus::robot {
namespace {

bool stands_at(const RobotModel& model, const JointVector& q, int link, const Pose& target) {
  const Pose pose = forward(model, q, link);
  return inside_limits(model, q, 0.0) && (pose.translation() - target.translation()).norm() <= 1.1e-6 &&
         geometry::angle_between(pose, target) <= 1.1e-6;
}

/// Seeds out of `trials` from which a random reachable pose is found. Every pose that is must be the one asked for.
int count_found(const RobotModel& model, int link, int trials, std::uint64_t seed) {
  support::Rng rng(seed);
  int found = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const Pose target = forward(model, testing::random_inside(model, rng), link);
    const auto q = inverse(model, link, target, testing::random_inside(model, rng));
    if (!q) continue;
    EXPECT_TRUE(stands_at(model, *q, link, target));
    ++found;
  }
  return found;
}

TEST(Inverse, FindsMostReachablePosesFromRandomSeeds) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  EXPECT_GT(count_found(arm, arm.find_link("l6"), 1000, 11), 850);
}

TEST(Inverse, NeverGivesAWrongPoseWithMimicJointsAndTooFewOfThem) {
  const RobotModel tree = testing::load_text(testing::tree_urdf);
  EXPECT_GT(count_found(tree, tree.find_link("tip"), 500, 12), 100);
}

TEST(Inverse, FollowsALineInAFewSteps) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  JointVector q{{0.3, -1.2, 1.5, -0.4, 1.3, 0.7}};
  Pose target = forward(arm, q, tool);
  InverseOptions few;
  few.iterations = 4;
  for (int step = 0; step < 50; ++step) {
    target.translation() += geometry::Vector3(0.003, -0.002, 0.002);
    const auto next = inverse(arm, tool, target, q, few);
    ASSERT_TRUE(next) << step;
    EXPECT_TRUE(stands_at(arm, *next, tool, target));
    EXPECT_LT((*next - q).cwiseAbs().maxCoeff(), 0.05);
    q = *next;
  }
}

TEST(Inverse, WorksAtSingularPoses) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  for (const JointVector& q :
       {JointVector{{0.3, -1.2, 1.5, -0.4, 0.0, 0.7}}, JointVector{{0.1, -1.0, 0.0, 0.4, 1.3, 0.7}}}) {
    const Pose target = forward(arm, q, tool);
    const auto found = inverse(arm, tool, target, q + JointVector::Constant(6, 0.05));
    ASSERT_TRUE(found);
    EXPECT_TRUE(stands_at(arm, *found, tool, target));
  }
}

TEST(Inverse, ReachesPosesAtTheLimitsOfNarrowJoints) {
  std::string urdf = testing::arm_urdf;
  for (std::size_t at = 0; (at = urdf.find("6.2832", at)) != std::string::npos;) urdf.replace(at, 6, "1.5");
  const RobotModel arm = testing::load_text(urdf);
  const int tool = arm.find_link("l6");
  const JointVector q{{1.5, -1.5, 1.5, -1.5, 1.5, 1.5}};
  const Pose target = forward(arm, q, tool);
  const auto found = inverse(arm, tool, target, q - JointVector{{0.2, -0.2, 0.2, -0.2, 0.2, 0.2}});
  ASSERT_TRUE(found);
  EXPECT_TRUE(stands_at(arm, *found, tool, target));
  EXPECT_GT(count_found(arm, tool, 300, 17), 100);
}

TEST(Inverse, GivesUpWhereThereIsNoWay) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  EXPECT_FALSE(
      inverse(arm, arm.find_link("l6"), geometry::pose_from({2.0, 0.0, 0.0, 0.0, 0.0, 0.0}), JointVector::Zero(6)));
}

TEST(Inverse, IsDeterministicAndStartsInsideTheLimits) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  const Pose target = forward(arm, JointVector{{0.3, -1.2, 1.5, -0.4, 1.3, 0.7}}, tool);
  const JointVector outside{{0.4, -1.1, 9.0, -0.5, 1.2, 0.6}};
  EXPECT_EQ(inverse(arm, tool, target, outside), inverse(arm, tool, target, outside));
}

TEST(Inverse, JointsThatDoNotMoveTheLinkKeepTheirValue) {
  const RobotModel tree = testing::load_text(testing::tree_urdf);
  const int finger = tree.find_link("finger");
  const auto q =
      inverse(tree, finger, forward(tree, JointVector{{0.5, 0.2, 0.0}}, finger), JointVector{{0.4, 0.1, 0.77}});
  ASSERT_TRUE(q);
  EXPECT_NEAR((*q)[0], 0.5, 1e-5);
  EXPECT_NEAR((*q)[1], 0.2, 1e-5);
  EXPECT_EQ((*q)[2], 0.77);
}

TEST(Inverse, RefusesWhatIsNotFinite) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  Pose target = Pose::Identity();
  target.translation().x() = std::nan("");
  EXPECT_THROW(inverse(arm, 6, target, JointVector::Zero(6)), support::Error);
  EXPECT_THROW(inverse(arm, 6, Pose::Identity(), JointVector::Constant(6, std::nan(""))), support::Error);
  EXPECT_THROW(inverse(arm, 6, Pose::Identity(), JointVector::Zero(5)), support::Error);
}

TEST(InverseAll, SolutionsAreRightDifferentAndNearestFirst) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  support::Rng rng(13);
  for (int trial = 0; trial < 20; ++trial) {
    const JointVector seed = testing::random_inside(arm, rng);
    const Pose target = forward(arm, testing::random_inside(arm, rng), tool);
    const std::vector<JointVector> all = inverse_all(arm, tool, target, seed, rng, 50, 12);
    EXPECT_FALSE(all.empty());
    EXPECT_LE(all.size(), 12u);
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_TRUE(stands_at(arm, all[i], tool, target));
      EXPECT_LE((all[i > 0 ? i - 1 : 0] - seed).norm(), (all[i] - seed).norm() + 1e-9);
      for (std::size_t k = 0; k < i; ++k) EXPECT_GT((all[i] - all[k]).cwiseAbs().maxCoeff(), 1e-3);
    }
  }
}

TEST(InverseAll, FindsAllEightPosturesOfAnOrdinaryPose) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  const JointVector q{{0.3, -1.2, 1.5, -0.4, 1.3, 0.7}};
  support::Rng rng(14);
  const auto all = inverse_all(arm, tool, forward(arm, q, tool), q, rng, 200, 1000);
  std::vector<JointVector> postures;
  for (const JointVector& solution : all) {
    const auto same = [&](const JointVector& known) {
      return ((known - solution) / 2.0).array().sin().abs().maxCoeff() < 1e-3;
    };
    if (std::none_of(postures.begin(), postures.end(), same)) postures.push_back(solution);
  }
  EXPECT_EQ(postures.size(), 8u);
  EXPECT_LT((all.front() - q).norm(), 1e-3);
}

TEST(InverseAll, TurnsJointsTowardsTheSeed) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  const JointVector q{{0.3, -1.2, 1.5, -0.4, 1.3, 0.7}};
  JointVector seed = q;
  seed[0] = 5.9;
  seed[5] = -5.2;
  support::Rng rng(15);
  const JointVector nearest = inverse_all(arm, tool, forward(arm, q, tool), seed, rng).at(0);
  EXPECT_LT((nearest - seed).cwiseAbs().maxCoeff(), 3.1416);
}

TEST(InverseAll, DependsOnTheRandomSeedAlone) {
  const RobotModel arm = testing::load_text(testing::arm_urdf);
  const int tool = arm.find_link("l6");
  const JointVector q{{0.3, -1.2, 1.5, -0.4, 1.3, 0.7}};
  const Pose target = forward(arm, q, tool);
  support::Rng one(16), two(16);
  EXPECT_EQ(inverse_all(arm, tool, target, q, one), inverse_all(arm, tool, target, q, two));
}

}  // namespace
}  // namespace tactus::robot
