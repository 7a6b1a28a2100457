// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/episode.hpp"

/// Parts of cells drawn by lot: where they lie, and that the lot is fair.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Cell;
using belief::CellBelief;
using support::Deadline;
using support::Rng;

constexpr std::size_t all = 1u << 20;

const std::shared_ptr<const belief::Model>& model() {
  static const auto made =
      small_model(belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 200});
  return made;
}

std::vector<Cell> draw(const Belief& belief, std::size_t count, double radius, Rng& rng) {
  return belief.cells().draw_parts(belief.task(), belief.history(), count, radius, rng, Deadline::unlimited());
}

bool holds(const CellBelief& cells, const Cell& outer, const Cell& inner) {
  const PoseVector wide = cells.half_width(outer), narrow = cells.half_width(inner);
  for (std::size_t d = 0; d < 6; ++d)
    if (std::abs(inner.centre[d] - outer.centre[d]) > wide[d] - narrow[d] + 1e-9) return false;
  return true;
}

bool holds(const CellBelief& cells, const Cell& cell, const PoseVector& v) {
  const PoseVector half = cells.half_width(cell);
  for (std::size_t d = 0; d < 6; ++d)
    if (std::abs(v[d] - cell.centre[d]) > half[d] + 1e-9) return false;
  return true;
}

TEST(Parts, LieInACellAreFineEnoughAndMayHaveGivenTheHistory) {
  Rng rng(1);
  for (const std::uint64_t seed : {1u, 2u, 3u, 4u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 6; ++i) {
      episode.step();
      const CellBelief& cells = episode.belief.cells();
      const double radius = 0.005 * std::exp2(-6.0 * rng.uniform());  // finer than cells are split, too
      for (const Cell& part : draw(episode.belief, 30, radius, rng)) {
        ASSERT_FALSE(cells.all_of([&](const Cell& cell) { return !holds(cells, cell, part); }));
        ASSERT_LE(cells.radius(part), radius);
        ASSERT_TRUE(belief::may_reproduce(episode.belief.task(), episode.belief.history(),
                                          geometry::pose_from(part.centre), cells.radius(part)));
      }
    }
  }
}

TEST(Parts, HoldTheTruthIfNoneIsLeftOut) {
  Rng rng(2);
  for (const std::uint64_t seed : {11u, 12u, 13u, 14u, 15u, 16u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 8; ++i) episode.step();
    const std::vector<Cell> parts = draw(episode.belief, all, 0.0025, rng);
    EXPECT_TRUE(std::any_of(parts.begin(), parts.end(),
                            [&](const Cell& part) { return holds(episode.belief.cells(), part, episode.truth); }))
        << "seed " << seed << ", " << parts.size() << " parts";
  }
}

/// With less than nothing to spare, the parts are those that were drawn first.
TEST(Parts, AreCoarserOnceTheTimeIsUsedUp) {
  Rng rng(3);
  const Belief belief(model(), model()->task->scene().start);
  const auto parts =
      belief.cells().draw_parts(belief.task(), belief.history(), 10, 0.001, rng, Deadline(1e-9, UINT64_MAX));
  ASSERT_EQ(parts.size(), 10u);
  for (const Cell& part : parts) EXPECT_GT(belief.cells().radius(part), 0.001);
}

/// The share of those on one side, in each direction that is free.
std::array<double, 3> shares_above_the_middle(const std::vector<Cell>& parts) {
  const PoseVector& centre = model()->task->scene().prior.centre;
  std::array<double, 3> shares{};
  for (const Cell& part : parts)
    for (std::size_t d = 0; d < 3; ++d)
      shares[d] += (part.centre[d + 1] > centre[d + 1] ? 1.0 : 0.0) / static_cast<double>(parts.size());
  return shares;
}

/// Of few, drawn from cells drawn by lot; and of as many as there are cells, left out by lot once these are split.
TEST(Parts, AreDrawnFromEachHalfByItsShareOfAllThereAre) {
  constexpr double radius = 0.0016;
  Rng rng(4);
  for (const std::uint64_t seed : {0u, 21u, 22u, 23u, 24u, 25u}) {
    Episode episode(model(), seed);
    for (int i = 0; seed > 0 && i < 2; ++i) episode.step();
    const std::array<double, 3> wanted = shares_above_the_middle(draw(episode.belief, all, radius, rng));
    for (const std::size_t count : {std::size_t{20}, episode.belief.cells().size()}) {
      std::vector<Cell> drawn;
      while (drawn.size() < 1200)
        for (const Cell& part : draw(episode.belief, count, radius, rng)) drawn.push_back(part);
      const std::array<double, 3> found = shares_above_the_middle(drawn);
      for (std::size_t d = 0; d < 3; ++d)
        EXPECT_NEAR(found[d], wanted[d], 0.08) << "seed " << seed << ", dimension " << d << ", " << count;
    }
  }
}

/// The share of those that come from a cell coarser than the finest there is.
double share_of_coarse(const CellBelief& cells, const std::vector<Cell>& parts) {
  double finest = 1.0, coarse = 0.0;
  cells.for_each([&](const Cell& cell) { finest = std::min(finest, cells.radius(cell)); });
  for (const Cell& part : parts)
    coarse +=
        cells.all_of([&](const Cell& cell) { return cells.radius(cell) < 1.1 * finest || !holds(cells, cell, part); })
            ? 0.0
            : 1.0;
  return coarse / static_cast<double>(parts.size());
}

TEST(Parts, AreDrawnFromCellsOfEachSizeByTheirShareOfAllThereAre) {
  constexpr double radius = 0.0008;
  Rng rng(5);
  for (const std::uint64_t seed : {21u, 25u, 39u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 4; ++i) episode.step();
    const CellBelief& cells = episode.belief.cells();
    const double wanted = share_of_coarse(cells, draw(episode.belief, all, radius, rng));
    std::vector<Cell> drawn;
    while (drawn.size() < 2000)
      for (const Cell& part : draw(episode.belief, 20, radius, rng)) drawn.push_back(part);
    EXPECT_NEAR(share_of_coarse(cells, drawn), wanted, 0.06) << "seed " << seed;
  }
}

}  // namespace
}  // namespace tactus::test
