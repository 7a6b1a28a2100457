// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "action/insertion.hpp"
#include "action/near_pokes.hpp"
#include "action/primitives.hpp"
#include "action/probes.hpp"
#include "belief/small_task.hpp"
#include "motion/path_laws.hpp"

/// What holds of every motion of the search: free, inside the limits, no point of the robot moving more than the step,
/// and costs that add up.
namespace tactus::test {
namespace {

using action::Kind;
using action::Motion;
using action::MotionPtr;
using support::Rng;

const action::Task& task() {
  static const auto made = small_task();
  return *made;
}

/// Free configurations of the search: on the retreat plane and beside the region.
JointVector random_free(Rng& rng) {
  for (;;) {
    const Vector3 position(rng.uniform(-0.06, 0.06), rng.uniform(-0.06, 0.06),
                           task().frame().standoff + rng.uniform(-0.02, 0.03));
    if (const auto q = task().posture(task().frame().base_from_tool(position, rng.uniform(-0.8, 0.8)), task().home()))
      return *q;
  }
}

double way(const Motion& motion, std::size_t i) {
  const Pose from = task().base_from_tool(motion.path[i - 1]), to = task().base_from_tool(motion.path[i]);
  return (to.translation() - from.translation()).norm() + 0.05 * geometry::angle_between(from, to);
}

void expect_sound(const Motion& motion, double step) {
  expect_free_in_steps(task().known_world(), motion.path, step);
  for (const JointVector& q : motion.path) ASSERT_TRUE(robot::inside_limits(*task().scene().robot, q));
  ASSERT_EQ(motion.bodies.size(), motion.path.size());
  ASSERT_EQ(motion.cost_to.size(), motion.path.size());
  double cost = 0.0;
  for (std::size_t i = 1; i < motion.path.size(); ++i) ASSERT_NEAR(motion.cost_to[i], cost += way(motion, i), 1e-9);
  ASSERT_TRUE(motion.base_from_start.isApprox(task().base_from_tool(motion.path.front())));
  ASSERT_FALSE(motion.pace.empty());
  ASSERT_EQ(motion.pace.front().first, 0u);
}

TEST(Primitives, AreSoundAndStartWhereTheRobotIs) {
  Rng rng(1);
  for (int i = 0; i < 12; ++i) {
    const JointVector q = random_free(rng);
    const std::vector<MotionPtr> motions = action::primitives(task(), q);
    EXPECT_GT(motions.size(), 8u);
    std::set<Kind> kinds;
    for (const MotionPtr& motion : motions) {
      ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, task().options().motion.step));
      EXPECT_EQ(motion->path.front(), q);
      EXPECT_FALSE(motion->anchored);
      kinds.insert(motion->kind);
    }
    EXPECT_EQ(kinds, (std::set{Kind::move, Kind::turn}));
  }
}

TEST(Primitives, KeepToTheirAxesAndLengths) {
  Rng rng(2);
  const JointVector q = random_free(rng);
  const Pose search_from_base = task().frame().base_from_search.inverse();
  const Pose from = search_from_base * task().base_from_tool(q);
  for (const MotionPtr& motion : action::primitives(task(), q)) {
    const Pose to = search_from_base * task().base_from_tool(motion->path.back());
    const Vector3 moved = to.translation() - from.translation();
    const double turned = geometry::angle_between(from, to);
    if (motion->kind == Kind::move) {
      EXPECT_LT(turned, 1e-5);
      EXPECT_NEAR(moved.cwiseAbs().maxCoeff(), moved.norm(), 1e-5);
      EXPECT_LT(moved.norm(), 0.06 + 1e-5);
    } else {
      EXPECT_LT(moved.norm(), 1e-5);
      EXPECT_LT(turned, 0.2 + 1e-5);
    }
  }
}

TEST(Primitives, AlongOneRayArePrefixesOfOneAnother) {
  Rng rng(3);
  const std::vector<MotionPtr> motions = action::primitives(task(), random_free(rng));
  for (std::size_t i = 1; i < motions.size(); ++i) {
    const auto &shorter = motions[i - 1]->path, &longer = motions[i]->path;
    if (shorter.size() >= longer.size() || shorter[1] != longer[1]) continue;
    EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
  }
}

TEST(Primitives, WhatTheWorldBlocksIsAsLongAsItIsFree) {
  const JointVector q = joints({0.46, 0.09, 0.0, 0.0, 0.0, 0.0});  // beside the post: less than 2 cm to go
  ASSERT_TRUE(task().known_world().is_free(q));
  int towards = 0;
  for (const MotionPtr& motion : action::primitives(task(), q)) {
    ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, task().options().motion.step));
    const double moved =
        task().base_from_tool(motion->path.back()).translation().y() - task().base_from_tool(q).translation().y();
    EXPECT_LT(moved, 0.013 + 1e-5);
    towards += moved > 0.0065;  // the axes of the search frame are turned a little
  }
  EXPECT_EQ(towards, 1);
}

TEST(Probes, AreSoundSetOutFromTheRetreatPlaneAndGoIntoTheRegion) {
  const std::vector<MotionPtr> motions = action::probes(task(), task().frame().region, task().home());
  EXPECT_GT(motions.size(), 8u);
  std::set<Kind> kinds;
  const Pose search_from_base = task().frame().base_from_search.inverse();
  for (const MotionPtr& motion : motions) {
    ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, task().options().motion.step));
    EXPECT_TRUE(motion->anchored);
    EXPECT_NEAR((search_from_base * motion->base_from_start.translation()).z(), task().frame().standoff, 1e-5);
    const double tip = (search_from_base * task().base_from_tool(motion->path.back()).translation()).z() +
                       task().frame().tool_extent.high.z();
    EXPECT_GT(tip, task().frame().region.low.z());
    kinds.insert(motion->kind);
  }
  EXPECT_EQ(kinds, (std::set{Kind::sweep, Kind::poke}));
}

TEST(Probes, AimAtASmallerRegionToo) {
  geometry::Box region = task().frame().region;
  region.low += 0.4 * region.size();
  region.high = region.low + 0.02 * Vector3::Ones();
  for (const MotionPtr& motion : action::probes(task(), region, task().home(), 2)) {
    ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, task().options().motion.step));
  }
}

TEST(Probes, SweepOverTheTargetWhereverItIsInADeepRegion) {
  const auto deep = small_task({.roll_width = 0.2, .depth_width = 0.2});
  std::vector<MotionPtr> sweeps = action::probes(*deep, deep->frame().region, deep->home());
  std::erase_if(sweeps, [](const MotionPtr& motion) { return motion->kind != Kind::sweep; });
  Rng rng(5);
  for (int i = 0; i < 100; ++i) {
    const Pose target = deep->scene().prior.sample(rng);
    EXPECT_TRUE(std::any_of(sweeps.begin(), sweeps.end(), [&](const MotionPtr& sweep) {
      return deep->target_contact().first_contact(sweep->bodies, target).has_value();
    })) << target.translation().transpose();
  }
}

TEST(NearPokes, AreSoundAndGoFartherInBesideWhereTheToolIs) {
  Rng rng(6);
  const Pose search_from_base = task().frame().base_from_search.inverse();
  int in_all = 0;
  for (int i = 0; i < 10; ++i) {
    const JointVector q = random_free(rng);
    const Vector3 from = search_from_base * task().base_from_tool(q).translation();
    for (const MotionPtr& motion : action::near_pokes(task(), q)) {
      ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, task().options().motion.step));
      EXPECT_EQ(motion->path.front(), q);
      EXPECT_FALSE(motion->anchored);
      EXPECT_EQ(motion->kind, Kind::poke);
      double farthest_back = 0.0;
      for (const JointVector& at : motion->path)
        farthest_back =
            std::max(farthest_back, from.z() - (search_from_base * task().base_from_tool(at).translation()).z());
      EXPECT_NEAR(farthest_back, 0.03, 0.002);
      const Vector3 moved = search_from_base * task().base_from_tool(motion->path.back()).translation() - from;
      EXPECT_GT(moved.z(), -0.032);
      EXPECT_LT(moved.z(), 0.102);
      EXPECT_GT(moved.head<2>().norm(), 0.038);
      EXPECT_LT(moved.head<2>().norm(), 0.102);
      ++in_all;
    }
  }
  EXPECT_GT(in_all, 20);
}

geometry::Box box_of_target(const Pose& pose) {
  geometry::Box box;
  const Pose search_from_target = task().frame().base_from_search.inverse() * pose;
  for (const Vector3& vertex : task().scene().target.mesh.vertices) box.add(search_from_target * vertex);
  return box;
}

/// By the standoff, wherever in the region the targets are; as far as that is from the whole region if they are all.
TEST(RetreatPlane, IsClearOfTheTargetsThatMayBe) {
  constexpr double pitch = 0.001;  // m between sites
  Rng rng(9);
  const scene::SearchFrame& frame = task().frame();
  EXPECT_EQ(action::retreat_plane(task(), frame.region), frame.standoff);
  const double clearance = frame.region.low.z() - frame.tool_extent.high.z() - frame.standoff;
  bool is_nearer = false;
  for (int i = 0; i < 20; ++i) {
    const Vector3 deeper = rng.uniform(0.0, 0.02) * frame.base_from_search.linear().col(2);
    const Pose target = Eigen::Translation3d(deeper) * task().scene().prior.sample(rng);
    const geometry::Box box = box_of_target(target);
    const double plane = action::retreat_plane(task(), box);
    is_nearer = is_nearer || plane > frame.standoff + 1e-4;
    EXPECT_NEAR(box.low.z() - frame.tool_extent.high.z() - plane, clearance, 1e-9);
    std::vector<MotionPtr> motions = action::probes(task(), box, task().home(), 2);
    motions.push_back(action::insertion(task(), target, task().home(), 0, plane));
    for (const MotionPtr& motion : motions) {
      if (!motion) continue;
      EXPECT_NEAR((frame.base_from_search.inverse() * motion->base_from_start.translation()).z(), plane, pitch);
      EXPECT_FALSE(task().target_contact().touches(motion->bodies, 0, target));
    }
  }
  EXPECT_TRUE(is_nearer);
}

TEST(Insertion, EndsSeatedGoingInAlongTheAxisInFineSteps) {
  Rng rng(4);
  const action::MotionOptions& options = task().options().motion;
  for (int i = 0; i < 12; ++i) {
    const Pose target = task().scene().prior.sample(rng);
    const MotionPtr motion = action::insertion(task(), target, task().home());
    ASSERT_TRUE(motion);
    ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, options.step));
    EXPECT_EQ(motion->kind, Kind::insertion);
    EXPECT_TRUE(motion->supposed_target.isApprox(target));
    EXPECT_TRUE(task().scene().is_seated(task().base_from_tool(motion->path.back()), target));
    const Pose seated = task().scene().seated(target);
    const Vector3 axis = target.linear() * task().scene().target.approach_axis;
    double before = 1e300;
    for (std::size_t w = 0; w < motion->path.size(); ++w) {
      const Pose tool = task().base_from_tool(motion->path[w]);
      const Vector3 left = seated.translation() - tool.translation();
      EXPECT_LT((left - axis.dot(left) * axis).norm(), 1e-5);
      EXPECT_LT(axis.dot(left), before);
      EXPECT_LT(geometry::angle_between(tool, seated), 1e-5);
      if (w > 0 && before < task().scene().target.approach_depth + 1e-5) {
        EXPECT_LE(vertex_motion(task().known_world().model(), motion->path[w - 1], motion->path[w]),
                  options.insertion_step * (1.0 + 1e-9));
      }
      before = axis.dot(left);
    }
  }
}

/// Back first, wherever the tool is: beside the seat, before it or past where it goes in.
TEST(Insertion, FromWhereTheToolIsEndsSeatedToo) {
  Rng rng(10);
  const double depth = task().scene().target.approach_depth;
  int past = 0, in_all = 0;
  for (int i = 0; i < 40; ++i) {
    const Pose target = task().scene().prior.sample(rng);
    const Vector3 axis = target.linear() * task().scene().target.approach_axis;
    const Pose seated = task().scene().seated(target);
    const MotionPtr elsewhere = action::insertion(task(), task().scene().prior.sample(rng), task().home());
    const JointVector q = i % 2 == 0 ? random_free(rng) : elsewhere->path.back();
    const Pose from = task().base_from_tool(q);
    const double cost = action::near_insertion_cost(task(), from, seated, axis);
    EXPECT_GE(cost, (seated.translation() - from.translation()).norm() + 0.05 * geometry::angle_between(from, seated));
    const MotionPtr motion = action::near_insertion(task(), target, q);
    if (!motion) continue;
    ++in_all;
    ASSERT_NO_FATAL_FAILURE(expect_sound(*motion, task().options().motion.step));
    EXPECT_EQ(motion->path.front(), q);
    EXPECT_FALSE(motion->anchored);
    EXPECT_EQ(motion->kind, Kind::insertion);
    EXPECT_TRUE(motion->supposed_target.isApprox(target));
    EXPECT_TRUE(task().scene().is_seated(task().base_from_tool(motion->path.back()), target));
    EXPECT_NEAR(motion->cost_to.back(), cost, 1e-3);
    double farthest_back = 0.0;
    for (const JointVector& at : motion->path) {
      const Vector3 moved = task().base_from_tool(at).translation() - from.translation();
      farthest_back = std::max(farthest_back, -axis.dot(moved));
    }
    const double is_past = axis.dot(from.translation() - seated.translation()) + depth;
    EXPECT_NEAR(farthest_back, std::max(0.01, is_past), 1e-3);
    past += is_past > 0.01;
  }
  EXPECT_GT(in_all, 20);
  EXPECT_GT(past, 2);
}

TEST(Motion, TheFirstWaypointsOfAMotionCostWhatTheyDid) {
  const MotionPtr whole = action::probes(task(), task().frame().region, task().home()).front();
  const MotionPtr part = action::truncated(task(), *whole, 5);
  ASSERT_EQ(part->path.size(), 5u);
  EXPECT_TRUE(std::equal(part->path.begin(), part->path.end(), whole->path.begin()));
  EXPECT_NEAR(part->cost_to.back(), whole->cost_to[4], 1e-12);
  EXPECT_EQ(part->anchored, whole->anchored);
}

TEST(Motion, JoinedPathsMeetInOneWaypoint) {
  const JointVector a = joints({0}), b = joints({1}), c = joints({2});
  EXPECT_EQ(action::joined({a, b}, {b, c}), (motion::JointPath{a, b, c}));
  EXPECT_EQ(action::joined({}, {b, c}), (motion::JointPath{b, c}));
}

TEST(Motion, TransitCostsNothingInPlaceAndNoLessThanTheStraightWay) {
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    const Pose from = task().base_from_tool(random_free(rng)), to = task().base_from_tool(random_free(rng));
    EXPECT_NEAR(action::transit_cost(task(), from, from), 0.0, 1e-6);
    EXPECT_GE(action::transit_cost(task(), from, to) + 1e-9, (from.translation() - to.translation()).norm());
  }
}

}  // namespace
}  // namespace tactus::test
