// SPDX-License-Identifier: BSD-3-Clause
#include "belief/modes.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "belief/small_task.hpp"

namespace tactus::test {
namespace {

using belief::Cell;
using belief::CellBelief;
using belief::Mode;

const belief::CellOptions options{.position = 0.01, .angle = 0.1, .most = 100000};

/// Cells of the first size about the given rolls (in cells from the prior's first), everywhere in y and z.
CellBelief at_rolls(const action::Task& task, const std::vector<int>& rolls) {
  const CellBelief all(task, options);
  const double first = task.scene().prior.centre[3] - 0.5 * task.scene().prior.width[3];
  std::vector<Cell> cells;
  all.for_each([&](const Cell& cell) {
    const auto roll = static_cast<int>((cell.centre[3] - first) / (2.0 * all.half_width(cell)[3]));
    if (std::find(rolls.begin(), rolls.end(), roll) != rolls.end()) cells.push_back(cell);
  });
  return CellBelief::restored(task, options, cells);
}

TEST(Modes, OfTheWholePriorAreOne) {
  const auto task = small_task({.roll_width = 1.0, .position_width = 0.04});
  const std::vector<Mode> modes = belief::modes_of(CellBelief(*task, options), task->scene().prior);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].mass, 1.0, 1e-12);
  for (int d = 0; d < 6; ++d) {
    EXPECT_NEAR(modes[0].extent[d], task->scene().prior.width[d], 1e-12);
    EXPECT_NEAR(modes[0].mean[d], task->scene().prior.centre[d], 1e-12);
  }
}

TEST(Modes, AreApartWhereACellIsBetweenThem) {
  const auto task = small_task({.roll_width = 1.0, .position_width = 0.04});
  const std::vector<Mode> modes = belief::modes_of(at_rolls(*task, {0, 2, 3, 7}), task->scene().prior);
  ASSERT_EQ(modes.size(), 3u);
  EXPECT_NEAR(modes[0].mass, 0.5, 1e-12);
  EXPECT_NEAR(modes[0].mean[3], task->scene().prior.centre[3] - 0.2, 1e-12);
  EXPECT_NEAR(modes[0].extent[3], 0.2, 1e-12);
  EXPECT_NEAR(modes[1].mass + modes[2].mass, 0.5, 1e-12);
}

TEST(Modes, GoRoundWithAFullTurn) {
  const auto task = small_task({.roll_width = 2.0 * std::numbers::pi, .position_width = 0.02});
  const CellBelief all(*task, options);
  const int last = static_cast<int>(std::lround(std::numbers::pi / all.half_width(Cell{})[3])) - 1;
  const std::vector<Mode> modes = belief::modes_of(at_rolls(*task, {0, 1, last}), task->scene().prior);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].extent[3], 6.0 * all.half_width(Cell{})[3], 1e-9);
  EXPECT_GT(std::abs(scene::nearest_angle(modes[0].mean[3] - task->scene().prior.centre[3], 0.0)), 3.0);
}

TEST(Modes, HoldCellsThatWereSplitTogether) {
  const auto task = small_task({.roll_width = 0.3, .position_width = 0.02});
  std::vector<Cell> halves;
  CellBelief(*task, options).for_each([&](const Cell& cell) {
    for (const double sign : {-0.25, 0.25}) {
      Cell half = cell;
      half.centre[1] += sign * 2.0 * CellBelief(*task, options).half_width(cell)[1];
      half.splits[1] = 1;
      halves.push_back(half);
    }
  });
  const std::vector<Mode> modes = belief::modes_of(CellBelief::restored(*task, options, halves), task->scene().prior);
  ASSERT_EQ(modes.size(), 1u);
  EXPECT_NEAR(modes[0].mass, 1.0, 1e-12);
}

}  // namespace
}  // namespace tactus::test
