// SPDX-License-Identifier: BSD-3-Clause
#include "motion/connect.hpp"

#include <gtest/gtest.h>

#include <future>

#include "contact/small_arm.hpp"
#include "motion/path_laws.hpp"

namespace tactus {
namespace {

using contact::KnownWorld;
using geometry::Mesh;
using motion::JointPath;
using robot::JointVector;
using support::Deadline;
using test::joints;

constexpr double step = 0.004;

const JointVector left = joints({1.2, 1.0, 0.5, 0.0, 0.0, 0.0});
const JointVector right = joints({-1.2, 1.0, 0.5, 0.0, 0.0, 0.0});

Mesh box_at(const geometry::Vector3& size, const geometry::Vector3& centre) {
  return geometry::transformed(geometry::box_mesh(size), geometry::Pose(Eigen::Translation3d(centre)));
}

// A wall in front of the arm, in the plane y = 0, with a gap 35 cm high between 0.35 and 0.7 m.
KnownWorld wall_with_gap() {
  return KnownWorld(test::small_arm(),
                    {box_at({0.8, 0.04, 0.35}, {0.6, 0.0, 0.175}), box_at({0.8, 0.04, 0.6}, {0.6, 0.0, 1.0})},
                    {"sill", "lintel"});
}

TEST(Densified, KeepsTheWaypointsAndTheStep) {
  const KnownWorld world(test::small_arm(), {}, {});
  support::Rng rng(3);
  for (int i = 0; i < 20; ++i) {
    const JointPath given{test::random_configuration(world.model(), rng),
                          test::random_configuration(world.model(), rng),
                          test::random_configuration(world.model(), rng)};
    const JointPath dense = motion::densified(world, given, step);
    EXPECT_EQ(dense.front(), given.front());
    EXPECT_EQ(dense.back(), given.back());
    EXPECT_NE(std::find(dense.begin(), dense.end(), given[1]), dense.end());
    for (std::size_t k = 1; k < dense.size(); ++k)
      ASSERT_LE(test::vertex_motion(world.model(), dense[k - 1], dense[k]), step);
  }
  EXPECT_TRUE(motion::densified(world, {}, step).empty());
}

TEST(IsFree, MeetsASingleWaypointInCollisionWhereverItStands) {
  const KnownWorld world = wall_with_gap();
  const JointVector blocked = joints({0.0, 1.2, 0.0, 0.0, 0.0, 0.0});
  ASSERT_FALSE(world.is_free(blocked));
  for (std::size_t size = 1; size < 20; ++size)
    for (std::size_t at = 0; at < size; ++at) {
      JointPath path(size, left);
      EXPECT_TRUE(motion::is_free(world, path));
      path[at] = blocked;
      EXPECT_FALSE(motion::is_free(world, path)) << at << " of " << size;
    }
}

TEST(Connect, IsTheStraightLineWhereThatIsFree) {
  const KnownWorld world(test::small_arm(), {}, {});
  const auto path = motion::connect(world, left, right, {}, Deadline::unlimited());
  ASSERT_TRUE(path);
  EXPECT_EQ(*path, motion::densified(world, {left, right}, step));
  EXPECT_EQ(*path, *motion::straight_joint_path(world, left, right, step));
}

TEST(Connect, FindsTheWayAroundAWall) {
  const KnownWorld world = wall_with_gap();
  ASSERT_FALSE(motion::straight_joint_path(world, left, right, step));
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const auto path =
        motion::connect(world, left, right, {.step = step, .iterations = 2000, .seed = seed}, Deadline::unlimited());
    ASSERT_TRUE(path) << "seed " << seed;
    EXPECT_EQ(path->front(), left);
    EXPECT_EQ(path->back(), right);
    test::expect_free_in_steps(world, *path, step);
  }
}

TEST(Connect, GivesTheSameAnswerWhateverWasAskedBefore) {
  const KnownWorld world = wall_with_gap();
  const auto ask = [&](std::uint64_t seed) {
    return motion::connect(world, left, right, {.step = 0.01, .iterations = 2000, .seed = seed}, Deadline::unlimited());
  };
  const auto first = ask(1), other = ask(2), again = ask(1);
  ASSERT_TRUE(first && other && again);
  EXPECT_EQ(*first, *again);
  EXPECT_NE(*first, *other);
}

TEST(Connect, GivesTheSameAnswerInEveryThread) {
  const KnownWorld world = wall_with_gap();
  const auto ask = [&] { return motion::connect(world, left, right, {.step = 0.01}, Deadline::unlimited()); };
  std::vector<std::future<std::optional<JointPath>>> answers;
  for (int thread = 0; thread < 4; ++thread) answers.push_back(std::async(std::launch::async, ask));
  const auto expected = ask();
  ASSERT_TRUE(expected);
  for (auto& answer : answers) EXPECT_EQ(*answer.get(), *expected);
}

TEST(Connect, HasNoAnswerFromOrToACollisionOrWithoutABudget) {
  const KnownWorld world = wall_with_gap();
  const JointVector blocked = joints({0.0, 1.2, 0.0, 0.0, 0.0, 0.0});
  EXPECT_FALSE(motion::connect(world, left, blocked, {}, Deadline::unlimited()));
  EXPECT_FALSE(motion::connect(world, blocked, left, {}, Deadline::unlimited()));
  EXPECT_FALSE(motion::connect(world, left, right, {}, Deadline(0.0, UINT64_MAX)));
  EXPECT_FALSE(motion::connect(world, left, right, {.step = step, .iterations = 1, .seed = 1}, Deadline::unlimited()));
}

}  // namespace
}  // namespace tactus
