// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "belief/episode.hpp"

/// What is proved of every pose that may have given a history, by looking into the cells.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Cell;
using belief::CellBelief;
using belief::Looked;
using support::Rng;

constexpr std::uint64_t many_looks = 20'000'000;

const std::shared_ptr<const belief::Model>& model() {
  static const auto made =
      small_model(belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 200});
  return made;
}

const action::Task& task() { return *model()->task; }

/// Poses drawn from all over the cells that reproduce the history exactly.
std::vector<PoseVector> poses_of(const Belief& belief, int tried, Rng& rng) {
  std::vector<PoseVector> poses;
  for (int i = 0; i < tried; ++i) {
    const PoseVector v = belief.cells().draw_in(belief.cells().draw_cell(rng), rng);
    if (const auto found = belief::projected(task(), belief.history(), v, 0.0);
        found && found->exact() && belief.contains(geometry::pose_from(found->pose)))
      poses.push_back(found->pose);
  }
  return poses;
}

/// That a pose's dimension `d` is below a bound: whatever has a bound between poses that it tells apart can be asked.
struct Below {
  std::size_t d;
  double bound;

  bool operator()(const PoseVector& v) const { return v[d] < bound; }
  bool operator()(const CellBelief& cells, const Cell& cell) const {
    return cell.centre[d] + cells.half_width(cell)[d] < bound;
  }
};

bool holds(const CellBelief& cells, const PoseVector& pose) {
  return !cells.all_of([&](const Cell& cell) {
    return !scene::box_holds(cell.centre, cells.half_width(cell), geometry::pose_from(pose), 1e-9);
  });
}

bool prove(CellBelief& cells, const Belief& belief, const Below& below, std::uint64_t most_looks = many_looks) {
  const CellBelief as_before = cells;
  const auto is_below = [&](const Cell& cell) { return below(as_before, cell); };
  return cells.look_inside(task(), belief.history(), is_below, most_looks) == Looked::all;
}

TEST(Proof, HoldsForEveryPoseThatReproducesTheHistory) {
  Rng rng(1);
  int proved = 0, refuted = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    Episode episode(model(), seed);
    for (int i = 0; i < 6; ++i) {
      episode.step();
      const Belief& belief = episode.belief;
      if (belief.cells().grid()) continue;
      const std::vector<PoseVector> poses = poses_of(belief, 40, rng);
      if (poses.empty()) continue;
      for (const std::size_t d : {1u, 2u, 3u}) {
        const PoseVector& some = poses[rng.below(poses.size())];
        const Below below{d, some[d] + rng.uniform(-1.0, 4.0) * 0.002};
        CellBelief cells = belief.cells();
        if (!prove(cells, belief, below)) {
          ++refuted;
          for (const PoseVector& v : poses) EXPECT_TRUE(holds(cells, v));
          continue;
        }
        ++proved;
        EXPECT_TRUE(below(episode.truth));
        for (const PoseVector& v : poses) EXPECT_TRUE(below(v)) << "seed " << seed << ", action " << i;
      }
    }
  }
  EXPECT_GT(proved, 5);
  EXPECT_GT(refuted, 5);
}

/// The cells that go are those of which no pose is left; the truth is never among them.
TEST(Proof, KeepsTheTruth) {
  for (std::uint64_t seed = 21; seed <= 28; ++seed) {
    Episode episode(model(), seed);
    for (int i = 0; i < 5; ++i) {
      episode.step();
      if (episode.belief.cells().grid()) continue;
      CellBelief cells = episode.belief.cells();
      if (!prove(cells, episode.belief, {1, episode.truth[1] + 0.004})) continue;
      EXPECT_TRUE(holds(cells, episode.truth)) << "seed " << seed;
    }
  }
}

std::shared_ptr<const belief::Model> model_with(const belief::CellOptions& cells) {
  belief::Options options = model()->options;
  options.cells = cells;
  return std::make_shared<const belief::Model>(model()->task, options);
}

TEST(Proof, IsTheSameOnAnyNumberOfThreads) {
  const auto threaded = [](int threads) {
    belief::CellOptions cells = model()->options.cells;
    cells.threads = threads;
    return model_with(cells);
  };
  const auto one = threaded(1), three = threaded(3);
  for (const std::uint64_t seed : {31u, 32u, 33u}) {
    Episode a(one, seed), b(three, seed);
    for (int i = 0; i < 6; ++i) {
      a.step(), b.step();
      ASSERT_EQ(a.belief.save(), b.belief.save());
      CellBelief cells_a = a.belief.cells(), cells_b = b.belief.cells();
      const Below below{1, a.truth[1] + 0.003};
      ASSERT_EQ(prove(cells_a, a.belief, below, 300'000), prove(cells_b, b.belief, below, 300'000));
      ASSERT_EQ(cells_a.cells(), cells_b.cells());
    }
  }
}

/// What is proved of fine cells is proved of coarse ones too: the parts are finer than cells are ever split.
TEST(Proof, GoesFinerThanCells) {
  belief::CellOptions coarse = model()->options.cells;
  coarse.finest_radius = 0.002;
  const auto with_coarse = model_with(coarse);
  int proved = 0;
  for (const std::uint64_t seed : {51u, 52u, 53u, 54u}) {
    Episode a(model(), seed), b(with_coarse, seed);
    for (int i = 0; i < 6; ++i) {
      a.step(), b.step();
      if (a.belief.cells().grid() || b.belief.cells().grid()) continue;
      CellBelief cells_a = a.belief.cells(), cells_b = b.belief.cells();
      const Below below{1, a.truth[1] + 0.002};
      if (!prove(cells_a, a.belief, below)) continue;
      ++proved;
      EXPECT_TRUE(prove(cells_b, b.belief, below)) << "seed " << seed << ", action " << i;
    }
  }
  EXPECT_GT(proved, 0);
}

TEST(Proof, IsGivenUpWithTooFewLooks) {
  Episode episode(model(), 41);
  while (episode.belief.cells().grid()) episode.step();
  CellBelief cells = episode.belief.cells();
  EXPECT_FALSE(prove(cells, episode.belief, {1, episode.truth[1] + 0.001}, 1));
}

/// What it found when it gave up is kept, and the truth is never among what goes.
TEST(Proof, MadeInSeveralGoesEndsAsOneMadeAtOnce) {
  constexpr std::uint64_t few_looks = 40'000;
  belief::CellOptions roomy = model()->options.cells;
  roomy.most = 10000;
  int goes = 0, proved = 0;
  for (std::uint64_t seed = 21; seed <= 28; ++seed) {
    Episode episode(model(), seed);
    for (int i = 0; i < 5; ++i) {
      episode.step();
      if (episode.belief.cells().grid()) continue;
      const Below below{1, episode.truth[1] + 0.004};
      CellBelief at_once = CellBelief::restored(task(), roomy, episode.belief.cells().cells()), bit_by_bit = at_once;
      if (!prove(at_once, episode.belief, below)) continue;
      double volume = bit_by_bit.volume();
      int left = 100;
      for (; !prove(bit_by_bit, episode.belief, below, few_looks) && left > 0; --left, ++goes) {
        EXPECT_LE(bit_by_bit.volume(), volume * (1.0 + 1e-9));
        EXPECT_TRUE(holds(bit_by_bit, episode.truth)) << "seed " << seed;
        volume = bit_by_bit.volume();
      }
      EXPECT_GT(left, 0) << "seed " << seed;
      ++proved;
    }
  }
  EXPECT_GT(proved, 3);
  EXPECT_GT(goes, 0);
}

TEST(LookInside, TakesAboutAsManyLooksAsEstimated) {
  constexpr double radius = 0.0015;
  Rng rng(6);
  belief::CellOptions options = model()->options.cells;
  options.most = 100000;
  for (const std::uint64_t seed : {61u, 62u, 63u, 64u, 65u, 66u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 3; ++i) episode.step();
    const std::vector<belief::Trace>& history = episode.belief.history();
    CellBelief coarse(task(), options);
    ASSERT_TRUE(coarse.update(task(), belief::believed(history)));
    ASSERT_GT(coarse.coarsest(), 1.3 * radius);
    constexpr double no_limit = std::numeric_limits<double>::infinity();
    Rng again = rng, same = rng;
    const double estimate = coarse.estimated_looks(task(), history, radius, no_limit, rng);
    EXPECT_EQ(coarse.estimated_looks(task(), history, radius, estimate, again), estimate);
    const double stopped = coarse.estimated_looks(task(), history, radius, estimate / 3.0, same);
    EXPECT_GT(stopped, estimate / 3.0);
    EXPECT_LE(stopped, estimate);
    const auto succeeds_with = [&](double looks) {
      CellBelief cells = coarse;
      const auto fine = [&](const Cell& cell) { return coarse.radius(cell) <= radius; };
      return cells.look_inside(task(), history, fine, static_cast<std::uint64_t>(looks)) == Looked::all;
    };
    EXPECT_TRUE(succeeds_with(2.0 * estimate)) << "seed " << seed << ", " << estimate;
    EXPECT_FALSE(succeeds_with(estimate / 2.0)) << "seed " << seed << ", " << estimate;
  }
}

TEST(LookInside, ReplacesCellsByTheirPartsAndKeepsTheTruthInOne) {
  constexpr double radius = 0.0012;
  for (const std::uint64_t seed : {71u, 72u, 73u, 74u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 4; ++i) episode.step();
    CellBelief cells = episode.belief.cells();
    if (cells.grid()) continue;
    const double volume = cells.volume();
    const auto fine = [&](const Cell& cell) { return cells.radius(cell) <= radius; };
    if (cells.look_inside(task(), episode.belief.history(), fine, many_looks) != Looked::all) continue;
    EXPECT_LE(cells.volume(), volume * (1.0 + 1e-9));
    EXPECT_LE(cells.size(), 2000u);
    EXPECT_TRUE(holds(cells, episode.truth)) << "seed " << seed;
  }
}

/// Of cells that could not be told from possible ones.
TEST(LookInside, FindsNothingWhereNoPoseCanHaveGivenTheHistory) {
  constexpr double radius = 0.0003;
  Rng rng(7);
  int found_none = 0;
  for (const std::uint64_t seed : {81u, 82u, 83u, 84u}) {
    Episode episode(model(), seed);
    for (int i = 0; i < 6; ++i) episode.step();
    const std::vector<PoseVector> possible = poses_of(episode.belief, 100, rng);
    for (int i = 0; i < 20; ++i) {
      const Cell cell = episode.belief.cells().draw_cell(rng);
      CellBelief alone = CellBelief::restored(task(), model()->options.cells, std::vector<Cell>{cell});
      const auto fine = [&](const Cell& part) { return alone.radius(part) <= radius; };
      if (alone.look_inside(task(), episode.belief.history(), fine, many_looks) != Looked::none) continue;
      ++found_none;
      EXPECT_EQ(alone.cells(), std::vector<Cell>{cell});
      for (const PoseVector& pose : possible)
        EXPECT_FALSE(scene::box_holds(cell.centre, alone.half_width(cell), geometry::pose_from(pose), 0.0));
    }
  }
  EXPECT_GE(found_none, 10);
}

/// A grid of so few cells is never split otherwise: the belief would stay as coarse as it is. Where all of it is seated
/// there is nothing more to know.
TEST(LookInside, IsWhatABeliefDoesOnceObservationsTellNothingMore) {
  int looked = 0;
  for (std::uint64_t seed = 91; seed <= 102; ++seed) {
    Episode episode(model(), seed);
    while (episode.belief.history().empty() || !episode.belief.history().back().contact) episode.step();
    const double coarsest = episode.belief.cells().coarsest();
    const action::Action action =
        insertion_at(task(), episode.library, episode.belief.configuration(), geometry::pose_from(episode.truth));
    const belief::Observation seen = episode.world.execute(action);
    const Belief once = [&] {
      Belief belief = episode.belief;
      belief.step(action, seen);
      return belief;
    }();
    if (once.is_goal()) continue;
    Belief often = once;
    for (int i = 0; i < 4; ++i) {
      often.set_configuration(action.path.front());
      often.step(action, seen);
      EXPECT_TRUE(often.contains(geometry::pose_from(episode.truth)));
      EXPECT_EQ(often.health(), belief::Health::good);
    }
    EXPECT_LE(often.cells().volume(), once.cells().volume());
    looked += often.cells().coarsest() < coarsest && often.cells().volume() < 0.5 * once.cells().volume() ? 1 : 0;
  }
  EXPECT_GE(looked, 2);
}

/// Cells too coarse to tell: with the pin in the hole the belief knows it all the same.
TEST(Proof, TellsThatThePinIsInWhereTheCellsAreTooCoarse) {
  const auto coarse =
      small_model(belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 60});
  int told = 0;
  for (std::uint64_t seed = 51; seed <= 56; ++seed) {
    Episode episode(coarse, seed);
    for (int i = 0; i < 4; ++i) episode.step();
    action::ActionLibrary library(*coarse->task);
    const Pose truth = geometry::pose_from(episode.truth);
    const action::Action action = insertion_at(*coarse->task, library, episode.belief.configuration(), truth);
    episode.belief.step(action, {false, action.path.back()});
    const Belief& belief = episode.belief;
    told += belief.is_goal();
    EXPECT_LE(belief.cells().size(), 600u);
    EXPECT_EQ(Belief::restore(coarse, belief.save().data(), belief.save().size()).is_goal(), belief.is_goal());
  }
  EXPECT_GT(told, 2);
}

}  // namespace
}  // namespace tactus::test
