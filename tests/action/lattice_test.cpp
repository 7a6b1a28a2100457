// SPDX-License-Identifier: BSD-3-Clause
#include "action/lattice.hpp"

#include <gtest/gtest.h>

#include <atomic>

#include "action/library.hpp"
#include "belief/small_task.hpp"

/// Places of the tool through the region, and the moves between them.
namespace tactus::test {
namespace {

using action::ActionLibrary;
using action::Lattice;
using action::MotionPtr;
using support::Rng;

constexpr double pitch = 0.03;

const action::Task& task() {
  static const auto made = small_task();
  return *made;
}

/// Somewhere in the region, past the retreat plane, turned by a little.
JointVector random_stand(Rng& rng) {
  const geometry::Box& region = task().frame().region;
  for (;;) {
    const Vector3 at(rng.uniform(region.low.x(), region.high.x()), rng.uniform(region.low.y(), region.high.y()),
                     task().frame().standoff + rng.uniform(0.0, 0.04));
    if (const auto q = task().posture(task().frame().base_from_tool(at, rng.uniform(-0.3, 0.3)), task().home()))
      return *q;
  }
}

double apart(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() + geometry::angle_between(a, b);
}

TEST(Lattice, GoesThroughWhereTheRobotStands) {
  Rng rng(1);
  for (int i = 0; i < 10; ++i) {
    const JointVector q = random_stand(rng);
    const Lattice lattice(task(), q, pitch);
    EXPECT_TRUE(lattice.passes(q));
    double nearest = 1e300;
    for (std::size_t place = 0; place < lattice.size(); ++place)
      nearest = std::min(nearest, apart(lattice.base_from_tool(place), task().base_from_tool(q)));
    EXPECT_LT(nearest, 0.011);  // a layer that is as near as that is the same
  }
}

TEST(Lattice, NeighboursAreNeighboursOfOneAnother) {
  Rng rng(2);
  const Lattice lattice(task(), random_stand(rng), pitch);
  for (std::size_t place = 0; place < lattice.size(); ++place)
    for (std::size_t direction = 0; direction < Lattice::directions; ++direction) {
      const auto next = lattice.neighbour(place, direction);
      if (!next) continue;
      EXPECT_EQ(lattice.neighbour(*next, direction ^ 1), place);
      const Vector3 way = task().frame().base_from_search.linear().transpose() *
                          (lattice.base_from_tool(*next).translation() - lattice.base_from_tool(place).translation());
      const auto axis = static_cast<Eigen::Index>(direction / 2);
      EXPECT_GT((direction % 2 == 0 ? 1.0 : -1.0) * way[axis], 0.0);
      EXPECT_NEAR(way.norm(), std::abs(way[axis]), 1e-6);
      EXPECT_TRUE(axis == 2 || std::abs(way.norm() - pitch) < 0.0011) << way.norm();  // sites are 1 mm apart
    }
}

TEST(Lattice, StepsLeadFromPlaceToPlaceAndAreFree) {
  Rng rng(3);
  const Lattice lattice(task(), random_stand(rng), pitch);
  int made = 0;
  for (std::size_t place = 0; place < lattice.size(); ++place)
    for (std::size_t direction = 0; direction < Lattice::directions; ++direction) {
      const MotionPtr step = lattice.step(place, direction);
      if (!step) continue;
      ++made;
      EXPECT_EQ(step, lattice.step(place, direction));
      EXPECT_LT(apart(task().base_from_tool(step->path.front()), lattice.base_from_tool(place)), 1e-5);
      EXPECT_LT(
          apart(task().base_from_tool(step->path.back()), lattice.base_from_tool(*lattice.neighbour(place, direction))),
          1e-5);
      for (const JointVector& q : step->path) EXPECT_TRUE(task().known_world().is_free(q));
    }
  EXPECT_GT(made, 20);
}

TEST(Lattice, TheWayBackIsTheWayForth) {
  Rng rng(6);
  const Lattice lattice(task(), random_stand(rng), pitch);
  for (std::size_t place = 0; place < lattice.size(); ++place)
    for (std::size_t direction = 0; direction < Lattice::directions; ++direction) {
      const auto next = lattice.neighbour(place, direction);
      if (!next) continue;
      const MotionPtr forth = lattice.step(place, direction), back = lattice.step(*next, direction ^ 1);
      ASSERT_EQ(forth == nullptr, back == nullptr);
      if (!forth) continue;
      ASSERT_TRUE(std::equal(forth->path.begin(), forth->path.end(), back->path.rbegin(), back->path.rend()));
      ASSERT_NEAR(forth->cost_to.back(), back->cost_to.back(), 1e-12);
    }
}

TEST(Lattice, StepsAreTheSameWhicheverOfThemIsAskedForFirst) {
  Rng rng(7);
  const JointVector q = random_stand(rng);
  const Lattice one(task(), q, pitch), other(task(), q, pitch);
  const std::size_t count = one.size() * Lattice::directions;
  for (std::size_t i = 0; i < count; ++i) one.step(i / Lattice::directions, i % Lattice::directions);
  for (std::size_t i = count; i-- > 0;) {
    const std::size_t place = i / Lattice::directions, direction = i % Lattice::directions;
    const MotionPtr first = one.step(place, direction), last = other.step(place, direction);
    ASSERT_EQ(first == nullptr, last == nullptr);
    if (first) {
      ASSERT_EQ(first->path, last->path);
    }
  }
}

/// Whether the straight way or its reverse was being made, nothing is kept of it.
TEST(Lattice, StepsAreTheSameWhetherOrNotSomebodyCancelledTheirMaking) {
  Rng rng(8);
  const JointVector q = random_stand(rng);
  const Lattice calm(task(), q, pitch), cancelled(task(), q, pitch);
  const std::atomic<bool> flag{true};
  std::size_t thrown = 0;
  for (std::size_t i = 0; i < calm.size() * Lattice::directions; ++i) {
    const std::size_t place = i / Lattice::directions, direction = i % Lattice::directions;
    try {
      cancelled.step(place, direction, &flag);
    } catch (const support::Cancelled&) {
      ++thrown;
    }
    const MotionPtr expected = calm.step(place, direction), found = cancelled.step(place, direction);
    ASSERT_EQ(expected == nullptr, found == nullptr);
    if (expected) {
      ASSERT_EQ(expected->path, found->path);
    }
  }
  EXPECT_GT(thrown, 20u);
}

TEST(Lattice, SomeStepMeetsTheTargetWhereverItIsInADeepRegion) {
  const auto deep = small_task({.roll_width = 0.2, .depth_width = 0.2});
  const Lattice lattice(*deep, deep->home(), pitch);
  Rng rng(5);
  for (int i = 0; i < 50; ++i) {
    const Pose target = deep->scene().prior.sample(rng);
    bool is_met = false;
    for (std::size_t place = 0; place < lattice.size() && !is_met; ++place)
      for (std::size_t direction = 0; direction < Lattice::directions && !is_met; ++direction)
        if (const MotionPtr step = lattice.step(place, direction))
          is_met = deep->target_contact().first_contact(step->bodies, target).has_value();
    EXPECT_TRUE(is_met) << target.translation().transpose();
  }
}

TEST(Lattice, IsKeptWhileTheRobotMovesAlongItsRows) {
  Rng rng(4);
  ActionLibrary library(task());
  const auto first = library.lattice_through(random_stand(rng));
  std::size_t moved = 0;
  for (std::size_t place = 0; place < first->size(); place += 7)
    if (const MotionPtr step = first->step(place, 0)) {
      EXPECT_EQ(library.lattice_through(step->path.back()), first);
      ++moved;
    }
  EXPECT_GT(moved, 0u);
  EXPECT_NE(library.lattice_through(random_stand(rng)), first);
}

}  // namespace
}  // namespace tactus::test
