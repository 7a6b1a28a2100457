// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <set>

#include "belief/episode.hpp"

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

int holding(const CellBelief& cells, const PoseVector& v) {
  int found = 0;
  cells.for_each([&](const Cell& cell) { found += holds(cells, cell, v); });
  return found;
}

Cell random_cell(const CellBelief& cells, Rng& rng) { return cells.cells()[rng.below(cells.size())]; }

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
  Episode episode(model(), seed);
  for (int i = 0; i < actions; ++i) {
    episode.step();
    after(episode.belief, episode.truth);
  }
}

TEST(Cells, CoverThePriorExactly) {
  const CellBelief cells(task(), {});
  Rng rng(3);
  double volume = 0.0;
  for (const Cell& cell : cells.cells()) volume += cells.volume(cell);
  EXPECT_NEAR(volume, 0.04 * 0.04 * 0.4, 1e-12);
  for (int i = 0; i < 500; ++i) {
    const PoseVector v = random_pose(task().scene().prior, rng);
    EXPECT_EQ(holding(cells, v), 1);
  }
}

TEST(Cells, RadiusBoundsHowFarAPointOfTheTargetIsOff) {
  Rng rng(4);
  observe(4, 3, [&](const Belief& belief, const PoseVector&) {
    const CellBelief& cells = belief.cells();
    for (int i = 0; i < 300; ++i) {
      const Cell cell = random_cell(cells, rng);
      const Pose centre = geometry::pose_from(cell.centre), other = geometry::pose_from(pose_in(cells, cell, rng));
      for (const Vector3& p : task().scene().target.mesh.vertices)
        ASSERT_LE((centre * p - other * p).norm(), cells.radius(cell) + 1e-12);
    }
  });
}

TEST(Cells, NeverWiden) {
  for (const std::uint64_t seed : {11u, 12u, 13u}) {
    CellBelief before(task(), model()->options.cells);
    observe(seed, 8, [&](const Belief& belief, const PoseVector&) {
      const CellBelief& after = belief.cells();
      const std::vector<Cell> parents = before.cells();
      for (const Cell& cell : after.cells()) {
        const auto parent =
            std::find_if(parents.begin(), parents.end(), [&](const Cell& c) { return holds(before, c, cell.centre); });
        ASSERT_NE(parent, parents.end());
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
      ASSERT_EQ(holding(cells, random_cell(cells, rng).centre), 1);
    }
  });
}

TEST(Cells, MayReproduceAtEveryResolutionWhatAPoseInThemDid) {
  Rng rng(6);
  observe(16, 10, [&](const Belief& belief, const PoseVector& truth) {
    const belief::Trace& trace = belief.history().back();
    CellBelief cells(task(), {.most = 0});
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

TEST(Cells, ThatAreFineAreNotSplitAndTheOthersAsFarAsThereIsRoom) {
  constexpr std::size_t most = 1500;
  Rng rng(21);
  int split = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed)
    observe(seed, 4, [&](const Belief& belief, const PoseVector& truth) {
      CellBelief cells(task(), {.most = most});
      if (!cells.update(task(), belief::believed(belief.history())) || cells.grid()) return;
      const double middle = random_cell(cells, rng).centre[1];
      const auto is_fine = [&](const Cell& cell) { return cell.centre[1] > middle; };
      CellBelief refined = cells;
      ASSERT_TRUE(refined.refine(task(), belief.history(), is_fine));
      std::set<PoseVector> left;
      double coarsest = 0.0;
      refined.for_each([&](const Cell& cell) {
        left.insert(cell.centre);
        if (!is_fine(cell)) coarsest = std::max(coarsest, refined.radius(cell));
      });
      cells.for_each([&](const Cell& cell) { ASSERT_TRUE(!is_fine(cell) || left.contains(cell.centre)); });
      EXPECT_TRUE(coarsest <= belief::CellOptions{}.finest_radius || refined.size() + most / 16 > most);
      EXPECT_GE(holding(refined, truth), 1);
      split += refined.size() > cells.size();
    });
  EXPECT_GT(split, 3);
}

TEST(Cells, SplitInSeveralGoesEndAsThoseThatAreSplitInOneAndHoldTheTruthAllAlong) {
  constexpr std::size_t room = 100000, a_few = 256;
  constexpr double fine_radius = 0.0015;
  int goes = 0, compared = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed)
    observe(seed, 3, [&](const Belief& belief, const PoseVector& truth) {
      const std::vector<belief::Trace>& history = belief.history();
      const auto traces = belief::believed(history);
      CellBelief at_once(task(), {.most = room});
      CellBelief bit_by_bit(task(), {.most = room, .most_looks = 1});
      if (!at_once.update(task(), traces) || at_once.grid()) return;
      ASSERT_TRUE(bit_by_bit.update(task(), traces));
      const auto is_fine = [&](const Cell& cell) { return at_once.radius(cell) <= fine_radius; };
      ASSERT_TRUE(at_once.refine(task(), history, is_fine));
      ASSERT_TRUE(at_once.all_of(is_fine));
      for (; !bit_by_bit.all_of(is_fine); ++goes) {
        const std::size_t before = bit_by_bit.size();
        ASSERT_TRUE(bit_by_bit.refine(task(), history, is_fine));
        ASSERT_LE(bit_by_bit.size(), before + a_few);
        ASSERT_GE(holding(bit_by_bit, truth), 1);
      }
      const auto centres = [](const CellBelief& cells) {
        std::set<PoseVector> found;
        cells.for_each([&](const Cell& cell) { found.insert(cell.centre); });
        return found;
      };
      ASSERT_EQ(centres(bit_by_bit), centres(at_once));
      ++compared;
    });
  EXPECT_GT(compared, 3);
  EXPECT_GT(goes, 5 * compared);
}

TEST(Cells, DrawnPosesLieInCellsAndReproduceTheHistoryOrComeNearButForAnEighth) {
  Rng rng(9);
  constexpr std::size_t count = 21;
  int enough = 0;
  observe(19, 8, [&](const Belief& belief, const PoseVector&) {
    const std::vector<belief::Drawn> drawn = belief.draw(count, rng);
    const std::vector<Pose> poses = belief::poses_of(drawn);
    ASSERT_FALSE(poses.empty());
    ASSERT_LE(poses.size(), count);
    for (const Pose& pose : poses) ASSERT_TRUE(belief.contains(pose));
    const auto close =
        std::count_if(drawn.begin(), drawn.end(), [](const belief::Drawn& one) { return one.miss <= 0.00025; });
    const double near = std::max(0.001, 0.15 * belief.cells().coarsest());
    const auto agreeing = std::count_if(poses.begin(), poses.end(), [&](const Pose& pose) {
      return belief::may_reproduce(task(), belief.history(), pose, 1.5 * near);
    });
    if (poses.size() > count / 3) {
      ASSERT_GE(static_cast<std::size_t>(agreeing) + count / 8, poses.size());
    }
    enough += static_cast<std::size_t>(close) >= count / 3;
  });
  EXPECT_GE(enough, 7);
}

TEST(Cells, DrawnPosesSayHowFarTheyAreOff) {
  Rng rng(29);
  int exact = 0;
  observe(19, 8, [&](const Belief& belief, const PoseVector&) {
    for (const belief::Drawn& drawn : belief.draw(21, rng)) {
      ASSERT_GE(drawn.miss, 0.0);
      ASSERT_EQ(drawn.miss == 0.0, belief::reproduces(task(), belief.history(), drawn.pose)) << drawn.miss;
      exact += drawn.miss == 0.0;
    }
  });
  EXPECT_GT(exact, 80);
}

/// After motions that met nothing the poses drawn are spread as those are that a plain draw leaves: none crowd beside
/// what was swept. Asked of the share that comes within 0.3 mm of it.
TEST(Cells, DrawnPosesDoNotCrowdBesideWhatWasSwept) {
  constexpr double beside = 0.0003;
  Rng rng(30);
  double difference = 0.0, variance = 0.0, episodes = 0.0;
  for (std::uint64_t seed = 41; seed < 71; ++seed) {
    Episode episode(model(), seed);
    for (int i = 0; i < 3; ++i) episode.step();
    const std::vector<belief::Trace>& history = episode.belief.history();
    if (std::any_of(history.begin(), history.end(), [](const belief::Trace& trace) { return trace.contact; })) continue;
    const auto is_beside = [&](const Pose& pose) {
      return std::any_of(history.begin(), history.end(), [&](const belief::Trace& trace) {
        return task().target_contact().first_within(trace.bodies, pose, beside, 0).has_value();
      });
    };
    double drawn_beside = 0.0, plain_beside = 0.0, plain_count = 0.0;
    const std::vector<belief::Drawn> drawn = episode.belief.draw(200, rng);
    for (const belief::Drawn& one : drawn) drawn_beside += is_beside(one.pose);
    for (int i = 0; i < 2000; ++i)
      if (const Pose pose = task().scene().prior.sample(rng); belief::reproduces(task(), history, pose))
        ++plain_count, plain_beside += is_beside(pose);
    const double share = plain_beside / plain_count;
    const auto count = static_cast<double>(drawn.size());
    difference += drawn_beside / count - share;
    variance += share * (1.0 - share) * (1.0 / count + 1.0 / plain_count);
    ++episodes;
  }
  ASSERT_GE(episodes, 5.0);
  EXPECT_LE(std::abs(difference), 4.0 * std::sqrt(variance)) << "in all of " << episodes << " episodes";
}

TEST(Cells, BitsAreThoseOfTheSummary) {
  observe(23, 8, [](const Belief& belief, const PoseVector&) { EXPECT_EQ(belief.bits(), belief.summary().bits); });
}

/// A belief as thin as a sheet, and a hand wide, is not all but known, though next to nothing of its volume is left.
TEST(Cells, BitsCountWhatTheTolerancesTellApartHoweverThinItIs) {
  constexpr double beyond_a_box = 0.3;  // bits: cells lie in the box that holds their centre
  const scene::Target& target = task().scene().target;
  const PoseVector tolerance{2.0 * target.position_tolerance, 2.0 * target.position_tolerance,
                             2.0 * target.position_tolerance, 2.0 * target.angle_tolerance,
                             2.0 * target.angle_tolerance,    2.0 * target.angle_tolerance};
  int thin = 0, known = 0;
  for (const std::uint64_t seed : {23u, 24u, 25u, 26u, 27u, 28u})
    observe(seed, 10, [&](const Belief& belief, const PoseVector&) {
      const belief::Summary summary = belief.summary();
      double tolerances = belief.cells().volume(), boxes = 1.0;
      for (std::size_t d = 0; d < 6; ++d) {
        if (task().scene().prior.width[d] > 0.0) tolerances /= tolerance[d];
        boxes *= std::max(1.0, std::ceil(summary.extent[d] / tolerance[d]) + 1.0);
      }
      const bool is_within =
          std::equal(summary.extent.begin(), summary.extent.end(), tolerance.begin(), std::less_equal<>{});
      ASSERT_GE(summary.bits, std::log2(tolerances) - beyond_a_box);
      ASSERT_LE(summary.bits, std::log2(boxes));
      if (is_within) {
        ASSERT_NEAR(summary.bits, 0.0, 1e-9);
      }
      known += is_within;
      thin += summary.bits > std::max(0.0, std::log2(tolerances)) + 1.0;
    });
  RecordProperty("thin", thin);
  EXPECT_GT(thin, 0);
  EXPECT_GT(known, 0);
}

/// Boxes of cells are asked before cells: what that drops beyond the cells' own answers must hold no pose that would
/// have given the trace, and nothing that a cell's own answer drops may stay.
TEST(Cells, OfAGridAreSiftedAsOneByOne) {
  Rng rng(10);
  int dropped = 0, kept = 0, beyond = 0;
  for (const std::uint64_t seed : {31u, 32u, 33u, 34u})
    observe(seed, 4, [&](const Belief& belief, const PoseVector&) {
      const belief::Trace& trace = belief.history().back();
      const belief::CellGrid all(belief::cell_shape(task().scene().prior, 0.005, 0.1, 1u << 20), task().target_reach());
      belief::CellGrid sifted = all;
      sifted.sift(task(), {&trace});
      belief::CellGrid by_three = all;
      by_three.sift(task(), {&trace}, {}, nullptr, 3);
      EXPECT_EQ(by_three.members().words(), sifted.members().words());
      const double radius = scene::cell_radius(all.half_width(), task().target_reach());
      all.members().for_each([&](std::size_t cell) {
        const bool may = belief::may_reproduce(task(), trace, geometry::pose_from(all.centre(cell)), radius);
        ++(may ? kept : dropped);
        if (!may) {
          EXPECT_FALSE(sifted.members().test(cell));
        }
        if (!may || sifted.members().test(cell)) return;
        ++beyond;
        for (int i = 0; i < 20; ++i) {
          PoseVector v = all.centre(cell);
          for (std::size_t d = 0; d < 6; ++d) v[d] += all.half_width()[d] * rng.uniform(-1.0, 1.0);
          EXPECT_FALSE(belief::reproduces(task(), trace, geometry::pose_from(v)));
        }
      });
      EXPECT_EQ(sifted.size(), sifted.members().count());
    });
  EXPECT_GT(dropped, 100);
  EXPECT_GT(kept, 100);
  EXPECT_LT(beyond, kept / 20);
}

TEST(Cells, OfAGridHoldAPoseAsOneByOne) {
  Rng rng(12);
  scene::Prior prior;
  prior.centre = {0.1, 0.2, 0.3, 0.4, 1.2, 3.0};
  prior.width = {0.1, 0.0, 0.2, 2.0 * std::numbers::pi, 1.0, 1.5};
  belief::CellGrid grid(belief::cell_shape(prior, 0.03, 0.3, 1u << 20), 0.1);
  support::Bitset some(grid.members().size());
  for (std::size_t i = 0; i < some.size(); ++i)
    if (rng.below(2) == 0) some.set(i);
  grid.assign(some);
  int held = 0;
  for (int i = 0; i < 1000; ++i) {
    PoseVector v = random_pose(prior, rng);
    if (i % 3 == 0) v[4] = 0.5 * std::numbers::pi;
    if (i % 4 == 0) v[3] = prior.centre[3] + (i % 8 == 0 ? 1 : -1) * std::numbers::pi;
    if (i % 5 == 0) v[2] = prior.centre[2] + 0.1 * (i % 2);
    const Pose pose = geometry::pose_from(v);
    const bool plainly = !grid.members().all_of(
        [&](std::size_t member) { return !scene::box_holds(grid.centre(member), grid.half_width(), pose, 1e-9); });
    ASSERT_EQ(grid.holds(pose, 1e-9), plainly) << i;
    held += plainly;
  }
  EXPECT_GT(held, 200);
  EXPECT_LT(held, 900);
}

TEST(Cells, OfAGridAreWidenedUntilTheyAreFewEnough) {
  const scene::Prior& prior = task().scene().prior;
  const belief::CellGrid grid(belief::cell_shape(prior, 0.0001, 0.001, 5000), task().target_reach());
  EXPECT_LE(grid.size(), 5000u);
  EXPECT_GT(grid.size(), 2500u);
  EXPECT_NEAR(grid.half_width()[3] / grid.half_width()[1], 10.0, 2.0);
}

TEST(Cells, AreLeftAloneWhenAnObservationLeavesNone) {
  CellBelief cells(task(), model()->options.cells);
  const std::vector<Cell> before = cells.cells();
  const action::Action action = action_along(task(), {joints({0.30, 0, 0, 0, 0, 0}), joints({0.302, 0, 0, 0, 0, 0})});
  const belief::Observation impossible{true, action.path.back()};
  const auto trace = belief::trace_of(task(), action, impossible, belief::locate(task(), action, impossible));
  EXPECT_FALSE(cells.update(task(), {&trace}));
  EXPECT_EQ(cells.cells(), before);
}

TEST(Cells, AreAsManyAsThereMayBeHoweverFineTheyAreAskedFor) {
  const scene::Prior prior{{0.5, 0.1, 0.0, 0.3, 0.0, 0.0}, {0.0, 0.08, 0.08, 1.0, 0.0, 0.0}};
  const belief::CellShape fine = belief::cell_shape(prior, 1e-6, 1e-5, 5000);
  for (const double finer : {1e-9, 1e-12, 1e-300}) {
    const belief::CellShape shape = belief::cell_shape(prior, finer, 10.0 * finer, 5000);
    EXPECT_LE(shape.cells(), 5000u);
    for (std::size_t d = 0; d < 6; ++d) EXPECT_NEAR(shape.count[d], fine.count[d], 0.1 * fine.count[d]) << finer;
  }
}

}  // namespace
}  // namespace tactus::test
