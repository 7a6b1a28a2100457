// SPDX-License-Identifier: BSD-3-Clause
#include "solver/walks.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <queue>

#include "solver/policy_setting.hpp"
#include "solver/walk_cost.hpp"

/// The ways on which the target is looked for.
namespace tactus::test {
namespace {

using action::Lattice;
using solver::Walks;

constexpr double blocked = 1e300;

/// Walks over a wide prior, and those of its poses that some step touches.
struct Walking {
  explicit Walking(std::size_t count, Rng& rng)
      : predictions(on, random_poses(count, rng, 1.0, *on)),
        walks(on, std::make_shared<const Lattice>(*on, on->home(), 0.04), predictions),
        members(count) {
    for (std::size_t place = 0; place < walks.lattice().size(); ++place)
      for (std::size_t direction = 0; direction < Lattice::directions; ++direction)
        members |= walks.step(place, direction).touched;
  }

  WalkCost best_from(const Pose& base_from_tool, std::size_t beam) const {
    return cost_of(walks.best(members, base_from_tool, beam), walks, members);
  }

  /// The least that any walk costs that touches all, by Dijkstra's algorithm over places and what is left there.
  double least_expected(const Pose& base_from_tool) const {
    using State = std::pair<std::size_t, std::uint64_t>;  // place, and what is left
    const auto total = static_cast<double>(members.count());
    const std::uint64_t all = members.words()[0];
    std::map<State, double> least;
    std::priority_queue<std::pair<double, State>, std::vector<std::pair<double, State>>, std::greater<>> open;
    const auto reach = [&](const State& state, double cost) {
      const auto [entry, is_new] = least.try_emplace(state, cost);
      if (!is_new && entry->second <= cost) return;
      entry->second = cost;
      open.emplace(cost, state);
    };
    for (std::size_t place = 0; place < walks.lattice().size(); ++place)
      if (const double cost = walks.entry_cost(base_from_tool, place); cost < blocked) reach({place, all}, cost);
    while (!open.empty()) {
      const auto [cost, state] = open.top();
      open.pop();
      const auto [place, left] = state;
      if (cost > least[state]) continue;
      if (left == 0) return cost;
      for (std::size_t direction = 0; direction < Lattice::directions; ++direction) {
        const Walks::Step& step = walks.step(place, direction);
        if (step.cost >= blocked) continue;
        const std::uint64_t then = left & ~step.touched.words()[0];
        reach({step.to, then}, cost + step.cost * 0.5 * (std::popcount(left) + std::popcount(then)) / total);
      }
    }
    return blocked;
  }

  std::shared_ptr<const action::Task> on = small_task({.roll_width = 0.2, .position_width = 0.4});
  solver::Predictions predictions;
  Walks walks;
  Bitset members;
};

TEST(Walks, CostNoLessThanTheBestOfAllAndWithAWideBeamLittleMore) {
  constexpr std::size_t beam = 96;
  Rng rng(1);
  double sum = 0.0, least_sum = 0.0;
  for (int i = 0; i < 6; ++i) {
    const Walking setting(8, rng);
    for (int k = 0; k < 3; ++k) {
      const Pose at = random_place(rng);
      const auto [cost, missed] = setting.best_from(at, beam);
      const double least = setting.least_expected(at);
      EXPECT_EQ(missed, 0u);
      EXPECT_GE(cost, least - 1e-9);
      sum += cost;
      least_sum += least;
    }
  }
  EXPECT_LT(sum, 1.05 * least_sum);
}

/// Out of time a walk is cut short, and nobody hears of it who can do without the rest.
TEST(Walks, CutShortCanStillBeGone) {
  constexpr std::size_t beam = 24;
  Rng rng(4);
  for (int i = 0; i < 6; ++i) {
    Walking setting(8, rng);
    const Pose at = random_place(rng);
    const solver::Walk whole = setting.walks.best(setting.members, at, beam);
    EXPECT_EQ(setting.walks.best_in_time(setting.members, at, beam).steps, whole.steps);
    setting.predictions.time_limit().set(support::TimeLimit::Clock::now());
    EXPECT_THROW(setting.walks.best(setting.members, at, beam), support::OutOfTime);
    const solver::Walk walk = setting.walks.best_in_time(setting.members, at, beam);
    setting.predictions.time_limit().lift();
    EXPECT_LT(walk.entry, blocked);
    EXPECT_LT(walk.steps.size(), whole.steps.size());
    for (std::size_t k = 0; k < walk.steps.size(); ++k) {
      const Walks::Step& step = setting.walks.step(walk.steps[k].first, walk.steps[k].second);
      EXPECT_LT(step.cost, blocked);
      if (k + 1 < walk.steps.size()) {
        EXPECT_EQ(step.to, walk.steps[k + 1].first);
      }
    }
  }
}

/// However far off the tool is: no step tells anything then for a while, and a beam that stays near it finds nothing.
TEST(Walks, TouchNearlyAllPosesFromWhereverTheToolIs) {
  Rng rng(2);
  for (const std::size_t beam : {6u, 24u})
    for (int i = 0; i < 4; ++i) {
      const Walking setting(60, rng);
      for (int k = 0; k < 6; ++k) {
        Pose at = random_place(rng);
        at.translation().x() -= rng.uniform(0.0, 0.2);
        EXPECT_LE(setting.best_from(at, beam).missed, 1u);
      }
    }
}

/// Who goes along a walk stays on its lattice: another one's steps would all have to be made first.
TEST(Walks, StepsLeadFromWhereTheRobotStandsToTheNextPlaces) {
  Rng rng(3);
  const Walking setting(8, rng);
  const Lattice& lattice = setting.walks.lattice();
  std::size_t found = 0;
  for (int i = 0; i < 40; ++i) {
    const std::size_t place = rng.below(lattice.size());
    const auto q = setting.on->posture(lattice.base_from_tool(place), setting.on->home());
    if (!q) continue;
    for (const action::MotionPtr& step : setting.walks.steps_from(*q)) {
      ++found;
      EXPECT_EQ(step->path.front(), *q);
      EXPECT_TRUE(lattice.passes(step->path.back()));
      const Vector3 end = setting.on->base_from_tool(step->path.back()).translation();
      bool is_next = false;
      for (std::size_t direction = 0; direction < Lattice::directions; ++direction)
        if (const auto next = lattice.neighbour(place, direction))
          is_next = is_next || (lattice.base_from_tool(*next).translation() - end).norm() < 0.001;
      EXPECT_TRUE(is_next);
    }
    const std::vector<action::MotionPtr> steps = setting.walks.steps_from(*q);
    const auto leads = [&](const action::MotionPtr& step, std::size_t direction) {
      const auto next = lattice.neighbour(place, direction);
      return next &&
             (lattice.base_from_tool(*next).translation() - setting.on->base_from_tool(step->path.back()).translation())
                     .norm() < 0.001;
    };
    for (std::size_t first = 0; first < Lattice::directions; ++first) {
      const std::vector<action::MotionPtr> reordered = setting.walks.steps_from(*q, first);
      ASSERT_EQ(reordered.size(), steps.size());
      if (std::any_of(steps.begin(), steps.end(), [&](const auto& step) { return leads(step, first); })) {
        EXPECT_TRUE(leads(reordered.front(), first));
      }
    }
    robot::JointVector elsewhere = *q;
    elsewhere[0] += 0.1;
    EXPECT_TRUE(setting.walks.steps_from(elsewhere).empty() || lattice.passes(elsewhere));
  }
  EXPECT_GT(found, 40u);
}

}  // namespace
}  // namespace tactus::test
