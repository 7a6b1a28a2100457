// SPDX-License-Identifier: BSD-3-Clause
#include "solver/touches.hpp"

#include <gtest/gtest.h>

#include "belief/episode.hpp"

/// Contacts that say nothing which another has not said.
namespace tactus::test {
namespace {

using solver::Choice;
using solver::Outcome;
using solver::Touch;
using support::Rng;

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.4, .position_width = 0.04});
  return made;
}

/// Calls `visit(motion, rng)` for random motions of two waypoints or more.
template <typename Visit>
void for_random_motions(std::uint64_t seed, Visit&& visit) {
  Rng rng(seed);
  action::ActionLibrary library(*task());
  for (int i = 0; i < 40; ++i) {
    action::Motion motion;
    motion.path = random_action(*task(), library, task()->scene().start, rng).path;
    if (motion.path.size() > 1) visit(action::finished(*task(), motion), rng);
  }
}

TEST(Touch, IsLikeItselfAndItsNeighbours) {
  for_random_motions(1, [](const action::MotionPtr& motion, Rng& rng) {
    const std::size_t to = 1 + rng.below(motion->path.size() - 1);
    const auto touch = solver::touch_between(motion->bodies, to - 1, to);
    if (!touch) return;
    EXPECT_NEAR(touch->way.norm(), 1.0, 1e-9);
    EXPECT_TRUE(alike(*touch, *touch));
    Touch beside = *touch;
    beside.base_from_tool.translation() += Vector3(0.0005, -0.0005, 0.0005);
    EXPECT_TRUE(alike(*touch, beside));
    EXPECT_TRUE(alike(beside, *touch));
  });
}

TEST(Touch, IsNotLikeOneElsewhereOrFromAnotherSide) {
  for_random_motions(2, [](const action::MotionPtr& motion, Rng& rng) {
    const std::size_t to = 1 + rng.below(motion->path.size() - 1);
    const auto touch = solver::touch_between(motion->bodies, to - 1, to);
    if (!touch) return;
    Touch elsewhere = *touch, turned = *touch, reversed = *touch;
    elsewhere.base_from_tool.translation().y() += 0.003;
    turned.base_from_tool.rotate(Eigen::AngleAxisd(0.1, Vector3::UnitX()));
    reversed.way = -touch->way;
    for (const Touch& other : {elsewhere, turned, reversed}) EXPECT_FALSE(alike(*touch, other));
  });
}

TEST(Touch, IsWhatATraceOfTheMotionEndsIn) {
  int seen = 0;
  for (const std::uint64_t seed : {3u, 4u, 5u}) {
    Episode episode(small_model(belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04}), seed);
    for (int i = 0; i < 8; ++i) {
      episode.step();
      const belief::Trace& trace = episode.belief.history().back();
      const auto touch = solver::touch_of(trace);
      if (touch) {
        EXPECT_TRUE(trace.contact);
        EXPECT_EQ(touch->base_from_tool.matrix(), trace.bodies.base_from_body(trace.path.size() - 1, 0).matrix());
        ++seen;
      }
    }
  }
  EXPECT_GT(seen, 4);
}

TEST(ShareAlike, IsTheProbabilityOfOutcomesThatBeginAndEndInTouchesLikeThese) {
  int compared = 0;
  for_random_motions(6, [&](const action::MotionPtr& motion, Rng& rng) {
    const std::size_t end = motion->path.size();
    if (end < 4) return;
    Choice choice{motion, {}};
    const std::size_t first = 1 + rng.below(end - 3);
    choice.outcomes.push_back({first, first, 0.5, 0.0, false, {}});
    choice.outcomes.push_back({first + 1, end - 1, 0.2, 0.0, false, {}});
    choice.outcomes.push_back({end, end, 0.3, 0.0, false, {}});
    const auto near = solver::touch_between(motion->bodies, first - 1, first);
    const auto far = solver::touch_between(motion->bodies, end - 2, end - 1);
    const auto next = solver::touch_between(motion->bodies, first, first + 1);
    if (!near || !far || !next) return;
    ++compared;
    EXPECT_EQ(share_alike(choice, {}), 0.0);
    EXPECT_NEAR(share_alike(choice, {*near, *next, *far}), 0.7, 1e-12);
    EXPECT_NEAR(share_alike(choice, {*near}), 0.5 + (alike(*near, *next) && alike(*near, *far) ? 0.2 : 0.0), 1e-12);
  });
  EXPECT_GT(compared, 5);
}

}  // namespace
}  // namespace tactus::test
