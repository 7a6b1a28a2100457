// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/plain_world.hpp"

/// What holds of cells whatever is observed.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Cell;
using belief::CellBelief;
using support::Rng;

const std::shared_ptr<const belief::Model>& model() {
  static const auto made =
      small_model(belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 200});
  return made;
}

const action::Task& task() { return *model()->task; }

bool holds(const CellBelief& cells, const Cell& cell, const PoseVector& v) {
  const PoseVector half = cells.half_width(cell);
  for (std::size_t d = 0; d < 6; ++d)
    if (std::abs(v[d] - cell.centre[d]) > half[d] + 1e-9) return false;
  return true;
}

/// A pose in the cell, its corners included.
PoseVector pose_in(const CellBelief& cells, const Cell& cell, Rng& rng) {
  PoseVector v = cell.centre;
  const PoseVector half = cells.half_width(cell);
  for (std::size_t d = 0; d < 6; ++d)
    v[d] += half[d] * (rng.below(2) == 0 ? rng.uniform(-1.0, 1.0) : rng.below(2) == 0 ? -1.0 : 1.0);
  return v;
}

/// A few observed actions; calls `after` with the belief behind each.
template <typename After>
void observe(std::uint64_t seed, int actions, After after) {
  Rng rng(seed);
  action::ActionLibrary library(task());
  const PoseVector truth = random_pose(task().scene().prior, rng);
  const PlainWorld world(task(), geometry::pose_from(truth));
  Belief belief(model(), task().scene().start);
  for (int i = 0; i < actions; ++i) {
    const action::Action action = random_action(task(), library, belief.configuration(), rng);
    belief.step(action, world.execute(action));
    after(belief, truth);
  }
}

TEST(Cells, CoverThePriorExactly) {
  const CellBelief cells(task(), {}, [](const Pose&, double) { return true; });
  Rng rng(3);
  double volume = 0.0;
  for (const Cell& cell : cells.cells()) volume += cells.volume(cell);
  EXPECT_NEAR(volume, 0.04 * 0.04 * 0.4, 1e-12);
  for (int i = 0; i < 500; ++i) {
    const PoseVector v = random_pose(task().scene().prior, rng);
    const auto in = std::count_if(cells.cells().begin(), cells.cells().end(),
                                  [&](const Cell& cell) { return holds(cells, cell, v); });
    EXPECT_EQ(in, 1);
  }
}

TEST(Cells, RadiusBoundsHowFarAPointOfTheTargetIsOff) {
  Rng rng(4);
  observe(4, 3, [&](const Belief& belief, const PoseVector&) {
    const CellBelief& cells = belief.cells();
    for (int i = 0; i < 300; ++i) {
      const Cell& cell = cells.cells()[rng.below(cells.cells().size())];
      const Pose centre = geometry::pose_from(cell.centre), other = geometry::pose_from(pose_in(cells, cell, rng));
      for (const Vector3& p : task().scene().target.mesh.vertices)
        ASSERT_LE((centre * p - other * p).norm(), cells.radius(cell) + 1e-12);
    }
  });
}

TEST(Cells, NeverWiden) {
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    CellBelief before(task(), model()->options.cells, [](const Pose&, double) { return true; });
    observe(seed, 8, [&](const Belief& belief, const PoseVector&) {
      const CellBelief& after = belief.cells();
      for (const Cell& cell : after.cells()) {
        const auto parent = std::find_if(before.cells().begin(), before.cells().end(),
                                         [&](const Cell& c) { return holds(before, c, cell.centre); });
        ASSERT_NE(parent, before.cells().end());
        for (std::size_t d = 0; d < 6; ++d) ASSERT_GE(cell.splits[d], parent->splits[d]);
      }
      before = after;
    });
  }
}

TEST(Cells, AreDisjoint) {
  Rng rng(5);
  observe(15, 8, [&](const Belief& belief, const PoseVector&) {
    const CellBelief& cells = belief.cells();
    for (int i = 0; i < 50; ++i) {
      const PoseVector v = cells.cells()[rng.below(cells.cells().size())].centre;
      const auto in = std::count_if(cells.cells().begin(), cells.cells().end(),
                                    [&](const Cell& cell) { return holds(cells, cell, v); });
      ASSERT_EQ(in, 1);
    }
  });
}

TEST(Cells, MayReproduceAtEveryResolutionWhatAPoseInThemDid) {
  Rng rng(6);
  observe(16, 10, [&](const Belief& belief, const PoseVector& truth) {
    const belief::Trace& trace = belief.history().back();
    CellBelief cells(task(), {.most = 0}, [](const Pose&, double) { return true; });
    for (int halvings = 0; halvings < 6; ++halvings) {
      Cell cell;
      for (std::size_t d = 0; d < 6; ++d) {
        cell.splits[d] = static_cast<std::uint8_t>(2 * halvings);
        const double half = cells.half_width(cell)[d];
        cell.centre[d] = truth[d] + half * rng.uniform(-1.0, 1.0);
      }
      EXPECT_TRUE(belief::may_reproduce(task(), trace, geometry::pose_from(cell.centre), cells.radius(cell)))
          << halvings;
    }
  });
}

/// Were a cell dropped that a pose in it speaks for, that pose could be the truth.
TEST(Cells, WhatIsDroppedHoldsNoPoseThatReproducesTheHistory) {
  Rng rng(8);
  observe(18, 6, [&](const Belief& belief, const PoseVector&) {
    for (int i = 0; i < 400; ++i) {
      const PoseVector v = random_pose(task().scene().prior, rng);
      const Pose pose = geometry::pose_from(v);
      const bool reproduced =
          std::all_of(belief.history().begin(), belief.history().end(),
                      [&](const belief::Trace& trace) { return belief::reproduces(task(), trace, pose); });
      if (reproduced) {
        ASSERT_TRUE(belief.contains(pose));
      }
    }
  });
}

TEST(Cells, DrawnPosesLieInCellsAndReproduceTheHistoryUnlessTheyAreHardToFind) {
  Rng rng(9);
  constexpr std::size_t count = 21;
  int full = 0;
  observe(19, 8, [&](const Belief& belief, const PoseVector&) {
    const std::vector<Pose> poses = belief.draw(count, rng);
    ASSERT_FALSE(poses.empty());
    ASSERT_LE(poses.size(), count);
    for (const Pose& pose : poses) ASSERT_TRUE(belief.contains(pose));
    if (poses.size() <= count / 3) return;  // made up by poses that come near
    ++full;
    for (const Pose& pose : poses)
      for (const belief::Trace& trace : belief.history()) ASSERT_TRUE(belief::reproduces(task(), trace, pose));
  });
  EXPECT_GT(full, 0);
}

TEST(Cells, AreLeftAloneWhenAnObservationLeavesNone) {
  CellBelief cells(task(), model()->options.cells, [](const Pose&, double) { return true; });
  const std::vector<Cell> before = cells.cells();
  const action::Action action = action_along(task(), {joints({0.30, 0, 0, 0, 0, 0}), joints({0.302, 0, 0, 0, 0, 0})});
  const belief::Observation impossible{true, action.path.back()};
  const auto trace = belief::trace_of(task(), action, impossible, belief::locate(task(), action, impossible));
  EXPECT_FALSE(cells.update(task(), trace));
  EXPECT_EQ(cells.cells(), before);
}

}  // namespace
}  // namespace tactus::test
