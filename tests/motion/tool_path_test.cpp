// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "contact/small_arm.hpp"
#include "motion/connect.hpp"
#include "motion/path_laws.hpp"

namespace tactus {
namespace {

using contact::KnownWorld;
using geometry::Pose;
using geometry::Vector3;
using motion::JointPath;
using robot::JointVector;
using test::joints;

const JointVector bent = joints({0.3, 0.5, 1.1, 0.4, 0.9, 0.2});

Pose shifted(const Pose& pose, const Vector3& by, double turn = 0.0) {
  Pose goal = Eigen::Translation3d(by) * pose;
  goal.rotate(Eigen::AngleAxisd(turn, Vector3::UnitX()));
  return goal;
}

// Every waypoint on the line between the poses, in order.
void expect_on_the_line(const robot::RobotModel& model, int link, const JointPath& path, const Pose& from,
                        const Pose& to) {
  const Vector3 way = to.translation() - from.translation();
  double before = -1.0;
  for (const JointVector& q : path) {
    const Pose pose = robot::forward(model, q, link);
    const double fraction = (pose.translation() - from.translation()).dot(way) / way.squaredNorm();
    EXPECT_GT(fraction, before);
    before = fraction;
    const Pose expected = geometry::interpolate(from, to, std::clamp(fraction, 0.0, 1.0));
    EXPECT_LT((pose.translation() - expected.translation()).norm(), 2e-6);
    EXPECT_LT(geometry::angle_between(pose, expected), 1e-4);
  }
}

void expect_reaches(const robot::RobotModel& model, int link, const JointVector& q, const Pose& goal) {
  const Pose pose = robot::forward(model, q, link);
  EXPECT_LT((pose.translation() - goal.translation()).norm(), 1e-6);
  EXPECT_LT(geometry::angle_between(pose, goal), 1e-6);
}

TEST(StraightToolPath, ObeysTheLawsOfPathsInAllDirections) {
  const KnownWorld world(test::small_arm(), {}, {});
  const int plate = world.model().find_link("plate");
  const Pose start = robot::forward(world.model(), bent, plate);
  for (const double step : {0.004, 0.001})
    for (const Vector3& way : {Vector3(0.1, 0, 0), Vector3(0, 0.1, 0), Vector3(0, 0, -0.1), Vector3(-0.05, 0.05, 0.02)})
      for (const double turn : {0.0, 0.3}) {
        const Pose goal = shifted(start, way, turn);
        const auto path = motion::straight_tool_path(world, plate, bent, goal, {.step = step});
        ASSERT_TRUE(path) << way.transpose() << " turned by " << turn;
        EXPECT_EQ(path->front(), bent);
        test::expect_free_in_steps(world, *path, step);
        expect_on_the_line(world.model(), plate, *path, start, goal);
        expect_reaches(world.model(), plate, path->back(), goal);
        EXPECT_EQ(*path, *motion::straight_tool_path(world, plate, bent, goal, {.step = step}))
            << "the same answer twice";
      }
}

TEST(StraightToolPath, StandsAtWholeStridesWhereTheStepAllows) {
  const KnownWorld world(test::small_arm(), {}, {});
  const int plate = world.model().find_link("plate");
  const Pose start = robot::forward(world.model(), bent, plate), goal = shifted(start, {0.0, 0.09, 0.0});
  for (const double stride : {0.0005, 0.001, 0.003, 0.018}) {
    const auto path = motion::straight_tool_path(world, plate, bent, goal, {.step = 0.004, .stride = stride});
    ASSERT_TRUE(path);
    test::expect_free_in_steps(world, *path, 0.004);
    std::set<long> met;
    for (const JointVector& q : *path) {
      const double strides =
          (robot::forward(world.model(), q, plate).translation() - start.translation()).norm() / stride;
      const long nearest = std::lround(strides);
      if (std::abs(strides - static_cast<double>(nearest)) * stride < 1e-6) {
        met.insert(nearest);
        continue;
      }
      EXPECT_GT(stride, 0.002) << "a waypoint between strides that the step would allow";
    }
    if (stride > 0.002) {
      EXPECT_EQ(met.size(), static_cast<std::size_t>(std::lround(0.09 / stride)) + 1);
    }
  }
}

TEST(StraightToolPath, TurnsOnTheSpot) {
  const KnownWorld world(test::small_arm(), {}, {});
  const int plate = world.model().find_link("plate");
  const Pose goal = shifted(robot::forward(world.model(), bent, plate), Vector3::Zero(), 0.4);
  const auto path = motion::straight_tool_path(world, plate, bent, goal, {.step = 0.004});
  ASSERT_TRUE(path);
  test::expect_free_in_steps(world, *path, 0.004);
  expect_reaches(world.model(), plate, path->back(), goal);
  EXPECT_NEAR(motion::tool_travel(world.model(), plate, *path).radians, 0.4, 1e-4);
  EXPECT_LT(motion::tool_travel(world.model(), plate, *path).metres, 1e-4);
}

TEST(StraightToolPath, KeepsTheFreePartBeforeAnObstacleIfAsked) {
  const test::Model arm = test::small_arm();
  const int plate = arm->find_link("plate");
  const Pose start = robot::forward(*arm, bent, plate), goal = shifted(start, {0.0, 0.0, -0.2});
  const Pose under = shifted(start, {0.0, 0.0, -0.2});
  const KnownWorld world(
      arm,
      {geometry::transformed(geometry::box_mesh({0.3, 0.3, 0.02}), Pose(Eigen::Translation3d(under.translation())))},
      {"table"});
  EXPECT_FALSE(motion::straight_tool_path(world, plate, bent, goal, {.step = 0.004}));
  const auto part = motion::straight_tool_path(world, plate, bent, goal, {.step = 0.004, .keep_free_part = true});
  ASSERT_TRUE(part);
  test::expect_free_in_steps(world, *part, 0.004);
  const double way = motion::tool_travel(*arm, plate, *part).metres;
  EXPECT_GT(way, 0.02);
  EXPECT_LT(way, 0.2);
}

TEST(StraightToolPath, StopsAtTheEndOfTheReach) {
  const KnownWorld world(test::small_arm(), {}, {});
  const int plate = world.model().find_link("plate");
  const Pose goal = shifted(robot::forward(world.model(), bent, plate), {3.0, 0.0, 0.0});
  EXPECT_FALSE(motion::straight_tool_path(world, plate, bent, goal, {.step = 0.01}));
  const auto part = motion::straight_tool_path(world, plate, bent, goal, {.step = 0.01, .keep_free_part = true});
  ASSERT_TRUE(part);
  test::expect_free_in_steps(world, *part, 0.01);
}

TEST(StraightToolPath, HasNoAnswerFromACollision) {
  const test::Model arm = test::small_arm();
  const int plate = arm->find_link("plate");
  const Pose start = robot::forward(*arm, bent, plate);
  const KnownWorld world(arm, {geometry::transformed(geometry::box_mesh({0.01, 0.01, 0.01}), start)}, {"pebble"});
  EXPECT_FALSE(motion::straight_tool_path(world, plate, bent, shifted(start, {0.0, 0.0, 0.05}),
                                          {.step = 0.004, .keep_free_part = true}));
}

TEST(StraightToolPathUr10e, ObeysTheLawsOfPaths) {
  const test::Model ur10e = test::makers_ur10e();
  if (!ur10e) GTEST_SKIP() << "the maker's UR10e is not on this machine";
  const KnownWorld world(ur10e, {}, {});
  const int tool = ur10e->find_link("tool0");
  const JointVector q = joints({0.2, -1.4, 1.8, -1.9, -1.5, 0.3});
  const Pose start = robot::forward(*ur10e, q, tool);
  for (const Vector3& way : {Vector3(0.2, 0, 0), Vector3(0, 0.2, 0), Vector3(0, 0, -0.2)}) {
    const Pose goal = shifted(start, way, 0.1);
    const auto path = motion::straight_tool_path(world, tool, q, goal, {.step = 0.004});
    ASSERT_TRUE(path) << way.transpose();
    test::expect_free_in_steps(world, *path, 0.004);
    expect_on_the_line(*ur10e, tool, *path, start, goal);
    expect_reaches(*ur10e, tool, path->back(), goal);
  }
}

}  // namespace
}  // namespace tactus
