// SPDX-License-Identifier: BSD-3-Clause
#include "action/library.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <thread>

#include "action/insertion.hpp"
#include "action/primitives.hpp"
#include "action/probes.hpp"
#include "belief/small_task.hpp"
#include "motion/path_laws.hpp"

/// Motions made executable from where the robot is.
namespace tactus::test {
namespace {

using action::Action;
using action::ActionLibrary;
using action::MotionPtr;
using support::Deadline;
using support::Rng;

const action::Task& task() {
  static const auto made = small_task();
  return *made;
}

void expect_executable(const Action& action, const JointVector& q, const action::Motion& motion) {
  expect_free_in_steps(task().known_world(), action.path, task().options().motion.step);
  ASSERT_EQ(action.path.front(), q);
  ASSERT_EQ(action.path.back(), motion.path.back());
  ASSERT_EQ(action.path.size(), action.lead + motion.path.size());
  ASSERT_TRUE(std::equal(motion.path.begin(), motion.path.end(),
                         action.path.begin() + static_cast<std::ptrdiff_t>(action.lead)));
  ASSERT_EQ(action.kind, motion.kind);
  ASSERT_EQ(action.id, action::path_id(action.path));
  ASSERT_EQ(action.bodies.size(), action.path.size());
  ASSERT_EQ(action.times.size(), action.path.size());
  ASSERT_EQ(action.times.front(), 0.0);
  for (std::size_t i = 1; i < action.times.size(); ++i) ASSERT_GT(action.times[i], action.times[i - 1]);
  const motion::ToolTravel travel = motion::tool_travel(*task().scene().robot, task().scene().tool_link, action.path);
  ASSERT_NEAR(action.length, travel.metres, 1e-12);
  ASSERT_NEAR(action.full_cost, travel.metres + 0.05 * travel.radians + 0.005, 1e-12);
}

TEST(Library, RealisesEveryMotionFromWhereTheRobotIs) {
  Rng rng(1);
  ActionLibrary library(task());
  const std::vector<MotionPtr> probes = action::probes(task(), task().frame().region, task().home());
  JointVector q = task().scene().start;
  for (int i = 0; i < 24; ++i) {
    const std::vector<MotionPtr> near = library.primitives_at(q);
    MotionPtr motion = i % 3 == 0   ? near[rng.below(near.size())]
                       : i % 3 == 1 ? probes[rng.below(probes.size())]
                                    : nullptr;
    if (!motion) motion = action::insertion(task(), task().scene().prior.sample(rng), q);
    const auto action = library.realise(q, *motion, Deadline::unlimited());
    ASSERT_TRUE(action) << i;
    ASSERT_NO_FATAL_FAILURE(expect_executable(*action, q, *motion)) << i;
    EXPECT_TRUE(motion->anchored || action->lead == 0);
    EXPECT_TRUE(action->supposed_target.isApprox(motion->supposed_target));
    q = action->path[rng.below(action->path.size())];  // as after a contact
  }
}

TEST(Library, TheWayOutOfTheTargetIsStraightBack) {
  ActionLibrary library(task());
  const Pose target = task().scene().prior.central_pose();
  const MotionPtr insertion = action::insertion(task(), target, task().home());
  const JointVector seated = insertion->path.back();
  const MotionPtr probe = action::probes(task(), task().frame().region, task().home()).front();
  const auto action = library.realise(seated, *probe, Deadline::unlimited());
  ASSERT_TRUE(action);
  ASSERT_NO_FATAL_FAILURE(expect_executable(*action, seated, *probe));
  const Vector3 axis = task().frame().base_from_search.linear().col(2),
                from = task().base_from_tool(seated).translation();
  for (const JointVector& q : action->path) {
    const Vector3 moved = task().base_from_tool(q).translation() - from;
    if (axis.dot(moved) >
        task().frame().standoff + 1e-4 - axis.dot(from - task().frame().base_from_search.translation())) {
      EXPECT_LT((moved - axis.dot(moved) * axis).norm(), 1e-5);
    } else {
      break;
    }
  }
}

/// How far the tool is past where a motion's start has it, along the search frame's axis.
double past(const JointVector& start, const JointVector& q) {
  const Vector3 axis = task().frame().base_from_search.linear().col(2);
  return axis.dot(task().base_from_tool(q).translation() - task().base_from_tool(start).translation());
}

/// A random walk of small motions from near the target, backwards.
motion::JointPath random_way_back(ActionLibrary& library, Rng& rng) {
  const MotionPtr insertion = action::insertion(task(), task().scene().prior.sample(rng), task().home());
  motion::JointPath way = insertion->path;
  for (int i = 0; i < 4; ++i) {
    const std::vector<MotionPtr> near = library.primitives_at(way.back());
    if (!near.empty()) way = action::joined(std::move(way), near[rng.below(near.size())]->path);
  }
  std::reverse(way.begin(), way.end());
  return way;
}

TEST(Library, BeginsWithTheWayBackAsFarAsTheRetreatPlane) {
  Rng rng(2);
  ActionLibrary library(task());
  const std::vector<MotionPtr> probes = action::probes(task(), task().frame().region, task().home());
  int bent = 0;
  for (int i = 0; i < 24; ++i) {
    const motion::JointPath way = random_way_back(library, rng);
    const MotionPtr motion = i % 3 == 0 ? action::insertion(task(), task().scene().prior.sample(rng), way.front())
                                        : probes[rng.below(probes.size())];
    const JointVector& start = motion->path.front();
    const auto action = library.realise(way.front(), *motion, Deadline::unlimited(), way);
    ASSERT_TRUE(action) << i;
    ASSERT_NO_FATAL_FAILURE(expect_executable(*action, way.front(), *motion)) << i;
    std::size_t followed = 0;
    while (followed <= action->lead && followed < way.size() && action->path[followed] == way[followed]) ++followed;
    ASSERT_GT(followed, 0u);
    EXPECT_TRUE(followed == way.size() || past(start, way[followed - 1]) <= 1e-6) << i;
    const auto straight = library.realise(way.front(), *motion, Deadline::unlimited());
    bent += straight && straight->path != action->path;
  }
  EXPECT_GT(bent, 5);
}

/// The wrist may be wound up either way: the arm does not unwind it on the way to a start that it stands at otherwise.
TEST(Library, TakesAStartAsItIsReachedWholeTurnsAway) {
  constexpr int wrist = 3;
  ActionLibrary library(task());
  const double z = task().frame().standoff;
  const auto q = task().posture(task().frame().base_from_tool({0.0, 0.0, z}, 3.0), task().home());
  ASSERT_TRUE(q);
  const MotionPtr near = action::anchored_motion(task(), action::Kind::poke, {{0.02, 0.0, z}, {0.02, 0.0, z + 0.01}},
                                                 (*q)[wrist] > 0.0 ? 3.2 : 3.1, *q);
  ASSERT_TRUE(near);
  action::Motion wound = *near;
  const double turn = std::copysign(2.0 * std::numbers::pi, (*q)[wrist]);
  for (JointVector& at : wound.path) at[wrist] -= turn;
  const MotionPtr motion = action::finished(task(), wound);
  ASSERT_TRUE(robot::inside_limits(*task().scene().robot, motion->path.front()));
  const auto action = library.realise(*q, *motion, Deadline::unlimited());
  ASSERT_TRUE(action);
  EXPECT_LT(action->full_cost, 0.1);
  ASSERT_EQ(action->path.size(), action->lead + motion->path.size());
  for (std::size_t i = 0; i < motion->path.size(); ++i)
    EXPECT_TRUE(
        task().base_from_tool(action->path[action->lead + i]).isApprox(task().base_from_tool(motion->path[i]), 1e-6));
}

TEST(Library, GoesRoundWhatBlocksTheStraightWay) {
  const JointVector behind_the_post = joints({0.46, 0.20, 0.0, 0.0, 0.0, 0.0});
  ASSERT_TRUE(task().known_world().is_free(behind_the_post));
  ActionLibrary library(task());
  const MotionPtr probe = action::probes(task(), task().frame().region, task().home()).front();
  const auto action = library.realise(behind_the_post, *probe, Deadline::unlimited());
  ASSERT_TRUE(action);
  ASSERT_NO_FATAL_FAILURE(expect_executable(*action, behind_the_post, *probe));
}

TEST(Library, FromTheMotionsOwnStartThereIsNoLead) {
  ActionLibrary library(task());
  const MotionPtr probe = action::probes(task(), task().frame().region, task().home()).front();
  const auto action = library.realise(probe->path.front(), *probe, Deadline::unlimited());
  ASSERT_TRUE(action);
  ASSERT_NO_FATAL_FAILURE(expect_executable(*action, probe->path.front(), *probe));
  EXPECT_EQ(action->lead, 0u);
  EXPECT_EQ(action->path, probe->path);
}

TEST(Library, KeepsThePrimitivesOfAConfiguration) {
  ActionLibrary library(task());
  const JointVector q = task().scene().start;
  const std::vector<MotionPtr> first = library.primitives_at(q);
  EXPECT_EQ(library.primitives_at(q), first);
  const std::vector<MotionPtr> anew = action::primitives(task(), q);
  ASSERT_EQ(anew.size(), first.size());
  for (std::size_t i = 0; i < anew.size(); ++i) EXPECT_EQ(anew[i]->path, first[i]->path);
}

TEST(Library, KeepsTheProbesOfARegionThatHardlyChanges) {
  ActionLibrary library(task());
  geometry::Box region = task().frame().region;
  const auto paths = [](const std::vector<MotionPtr>& motions) {
    std::vector<std::uint64_t> ids;
    for (const MotionPtr& motion : motions) ids.push_back(action::path_id(motion->path));
    return ids;
  };
  const std::vector<MotionPtr> made = library.probes_in(region, task().home(), 3);
  ASSERT_FALSE(made.empty());
  region.high -= 0.05 * region.size();
  region.low -= 0.01 * region.size();
  EXPECT_EQ(library.probes_in(region, task().home(), 3), made);
  region.high[0] -= 0.25 * region.size()[0];
  const std::vector<MotionPtr> narrower = library.probes_in(region, task().home(), 3);
  EXPECT_NE(paths(narrower), paths(made));
  EXPECT_EQ(paths(narrower), paths(ActionLibrary(task()).probes_in(region, task().home(), 3)));
}

TEST(Library, IsSharedByThreads) {
  ActionLibrary library(task());
  std::array<std::vector<MotionPtr>, 4> seen;
  std::vector<std::thread> threads;
  for (auto& mine : seen)
    threads.emplace_back([&] {
      for (int i = 0; i < 3; ++i)
        mine = library.primitives_at(task().scene().start + joints({-0.01 * i, 0, 0, 0, 0, 0}));
    });
  for (std::thread& thread : threads) thread.join();
  for (const auto& mine : seen) EXPECT_EQ(mine, seen[0]);
}

TEST(PathId, TellsPathsApart) {
  const JointVector a = joints({0.1, 0.2}), b = joints({0.2, 0.1});
  EXPECT_EQ(action::path_id({a, b}), action::path_id({a, b}));
  EXPECT_NE(action::path_id({a, b}), action::path_id({b, a}));
  EXPECT_NE(action::path_id({a, b}), action::path_id({a}));
}

}  // namespace
}  // namespace tactus::test
