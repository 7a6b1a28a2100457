// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "belief/episode.hpp"

/// Cells of a belief whose observations may err: what they weigh, against every observation taken apart by a world that
/// shares no contact code with the library.
namespace tactus::test {
namespace {

using action::Sensing;
using belief::Belief;
using belief::Doubt;
using belief::Fault;
using belief::FaultBits;
using belief::Trace;
using belief::WeighedCells;
using support::Rng;

constexpr Sensing rates{.missed_contacts = 0.1, .false_contacts = 0.1};

std::shared_ptr<const belief::Model> model() {
  static const auto made = small_model(
      belief::Kind::particles, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 2000, .sensing = rates});
  return made;
}

/// What a robot with these rates reports of an action: its contact missed, or one imagined, now and then.
belief::Observation observed(Episode& episode, const action::Action& action) {
  belief::Observation seen = episode.world.execute(action);
  if (seen.contact && episode.rng.uniform() < rates.missed_contacts) seen = {false, action.path.back()};
  if (!seen.contact && episode.rng.uniform() < rates.false_contacts)
    seen = {true, action.path[1 + episode.rng.below(action.path.size() - 1)]};
  return seen;
}

/// Some episodes; calls `visit(episode)` after every action.
template <typename Visit>
void for_episodes(std::uint64_t seed, int episodes, int actions, Visit visit) {
  for (int i = 0; i < episodes; ++i) {
    Episode episode(model(), seed + static_cast<std::uint64_t>(i));
    for (int k = 0; k < actions; ++k) {
      const action::Action action =
          random_action(episode.belief.task(), episode.library, episode.belief.configuration(), episode.rng);
      episode.belief.step(action, observed(episode, action));
      visit(episode);
    }
  }
}

bool holds(const WeighedCells& cells, const belief::Cell& cell, const PoseVector& pose) {
  const PoseVector half = cells.frame().half_width(cell);
  for (std::size_t d = 0; d < 6; ++d)
    if (std::abs(pose[d] - cell.centre[d]) > half[d] + 1e-12) return false;
  return true;
}

/// The faults of the history if the target is in this world, each waypoint looked at.
std::vector<Doubt> plain_faults(const PlainWorld& world, const std::vector<Trace>& history) {
  std::vector<Doubt> faults;
  for (std::size_t i = 0; i < history.size(); ++i) {
    const Trace& trace = history[i];
    const auto index = static_cast<std::uint16_t>(i);
    std::size_t clear = 0;
    while (i > 0 && clear < trace.touch && world.touches(trace.path[clear])) ++clear;
    bool missed = false, felt = false;
    for (std::size_t k = clear; k < trace.touch; ++k) missed = missed || world.touches(trace.path[k]);
    for (std::size_t k = trace.touch; k < trace.path.size(); ++k) felt = felt || world.touches(trace.path[k]);
    if (missed) faults.push_back({index, Fault::missed, true});
    if (trace.contact && (!felt || clear == trace.touch)) faults.push_back({index, Fault::imagined, true});
  }
  return faults;
}

TEST(WeighedCells, CoverThePriorOnce) {
  for_episodes(1, 3, 6, [](Episode& episode) {
    const WeighedCells& cells = *episode.belief.weighed();
    const double whole = cells.frame().volume(belief::Cell{});
    double sum = 0.0;
    for (const WeighedCells::Weighed& weighed : cells.all()) sum += cells.frame().volume(weighed.cell);
    EXPECT_NEAR(sum, whole, 1e-9 * whole);
    for (int i = 0; i < 20; ++i) {
      const PoseVector pose = random_pose(episode.belief.task().scene().prior, episode.rng);
      const auto count =
          std::count_if(cells.all().begin(), cells.all().end(),
                        [&](const WeighedCells::Weighed& weighed) { return holds(cells, weighed.cell, pose); });
      EXPECT_EQ(count, 1);
    }
  });
}

/// No pose has fewer faults than its cell: none weighs too little.
TEST(WeighedCells, DoubtNothingThatOneOfTheirPosesHasSeenRight) {
  std::size_t doubts = 0;
  for_episodes(11, 6, 8, [&](Episode& episode) {
    const WeighedCells& cells = *episode.belief.weighed();
    for (int i = 0; i < 4; ++i) {
      const PoseVector pose = i == 0 ? episode.truth : random_pose(episode.belief.task().scene().prior, episode.rng);
      const PlainWorld world(episode.belief.task(), geometry::pose_from(pose));
      const std::vector<Doubt> faults = plain_faults(world, episode.belief.history());
      for (const WeighedCells::Weighed& weighed : cells.all()) {
        if (!holds(cells, weighed.cell, pose)) continue;
        for (const Doubt& doubt : weighed.doubts) {
          if (!doubt.is_certain || doubt.fault == Fault::inside) continue;
          ++doubts;
          EXPECT_NE(std::find(faults.begin(), faults.end(), doubt), faults.end())
              << "observation " << doubt.trace << ", fault " << static_cast<int>(doubt.fault);
        }
      }
    }
  });
  EXPECT_GT(doubts, 100u);
}

TEST(WeighedCells, WeighWhatTheirDoubtsAreWorth) {
  const FaultBits bits(rates);
  EXPECT_NEAR(bits.missed, std::log2(10.0), 1e-12);
  for_episodes(21, 2, 5, [&](Episode& episode) {
    for (const WeighedCells::Weighed& weighed : episode.belief.weighed()->all()) {
      double least = 0.0;
      for (const Doubt& doubt : weighed.doubts)
        if (doubt.is_certain && doubt.fault != Fault::inside)
          least += doubt.fault == Fault::missed ? bits.missed : bits.imagined + 1.0;
      ASSERT_GE(weighed.cell.bits, least - 1e-9);
      ASSERT_TRUE(std::isfinite(weighed.cell.bits));
    }
    double sum = 0.0, best = 1e300;
    episode.belief.cells().for_each([&](const belief::Cell& cell) {
      sum += episode.belief.cells().weight(cell) / episode.belief.cells().weight();
      best = std::min(best, cell.bits);
    });
    EXPECT_NEAR(sum, 1.0, 1e-9);
    EXPECT_EQ(best, 0.0);
  });
}

/// Where one contact was imagined, and all else is right, the truth stays among the likely and that one is doubted.
TEST(WeighedCells, FindTheContactThatWasNone) {
  int told = 0, found = 0;
  for (std::uint64_t seed = 31; seed < 39; ++seed) {
    Episode episode(model(), seed);
    for (int i = 0; i < 14; ++i) {
      const action::Action action =
          random_action(episode.belief.task(), episode.library, episode.belief.configuration(), episode.rng);
      belief::Observation seen = episode.world.execute(action, 0.0, i == 2 ? 0.6 : 1.0);
      if (i == 2) seen.contact = true;
      episode.belief.step(action, seen);
    }
    EXPECT_TRUE(episode.belief.contains(geometry::pose_from(episode.truth)));
    const PlainWorld& world = episode.world;
    const std::vector<Doubt> faults = plain_faults(world, episode.belief.history());
    if (faults.size() != 1 || episode.belief.health() == belief::Health::good) continue;
    ++told;
    found += episode.belief.history()[2].doubted;
  }
  EXPECT_GE(told, 2);
  EXPECT_EQ(found, told);
}

TEST(WeighedCells, DrawPosesOfThePrior) {
  for_episodes(41, 2, 5, [](Episode& episode) {
    Rng rng(7), same(7);
    const std::vector<Pose> poses = belief::poses_of(episode.belief.draw(30, rng));
    EXPECT_EQ(poses.size(), 30u);
    for (const Pose& pose : poses) EXPECT_TRUE(episode.belief.task().scene().prior.contains(pose, 1e-6));
    const std::vector<Pose> again = belief::poses_of(episode.belief.draw(30, same));
    for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_EQ(poses[i].matrix(), again[i].matrix());
  });
}

TEST(WeighedCells, ActAfterRestoringAsBefore) {
  for_episodes(51, 2, 4, [](Episode& episode) {
    const std::vector<std::uint8_t> saved = episode.belief.save();
    Belief restored = Belief::restore(model(), saved.data(), saved.size());
    EXPECT_EQ(restored.save(), saved);
    Belief other = episode.belief;
    const action::Action action = random_action(other.task(), episode.library, other.configuration(), episode.rng);
    const belief::Observation seen = observed(episode, action);
    other.step(action, seen);
    restored.step(action, seen);
    EXPECT_EQ(restored.save(), other.save());
    EXPECT_EQ(restored.is_goal(), other.is_goal());
  });
}

/// A robot that was said to be right and is not: from then on it may err, and nothing is empty.
TEST(WeighedCells, TakeOverFromBeliefsThatAreContradicted) {
  for (const belief::Kind kind : {belief::Kind::hierarchical, belief::Kind::particles}) {
    const auto trusting = small_model(kind, {.roll_width = 0.4, .position_width = 0.04, .most_cells = 2000});
    int contradicted = 0;
    for (std::uint64_t seed = 61; seed < 66; ++seed) {
      Episode episode(trusting, seed);
      for (int i = 0; i < 10; ++i) {
        const action::Action action =
            random_action(episode.belief.task(), episode.library, episode.belief.configuration(), episode.rng);
        episode.belief.step(action, observed(episode, action));
        EXPECT_EQ(episode.belief.weighed().has_value(), episode.belief.health() == belief::Health::contradicted);
        EXPECT_GT(episode.belief.summary().cells + episode.belief.summary().possibly_occupied, 0u);
        EXPECT_TRUE(std::isfinite(episode.belief.summary().bits));
      }
      if (episode.belief.weighed()) {
        ++contradicted;
        EXPECT_TRUE(episode.belief.contains(geometry::pose_from(episode.truth)));
      }
    }
    EXPECT_GE(contradicted, 2);
  }
}

TEST(WeighedCells, NameEachDoubtOnceInTheOrderOfTracesAndFaults) {
  std::size_t named = 0;
  for_episodes(31, 4, 7, [&](const Episode& episode) {
    for (const WeighedCells::Weighed& weighed : episode.belief.weighed()->all()) {
      named += weighed.doubts.size();
      for (std::size_t i = 1; i < weighed.doubts.size(); ++i) {
        const Doubt &before = weighed.doubts[i - 1], &doubt = weighed.doubts[i];
        ASSERT_LT(std::pair(before.trace, before.fault), std::pair(doubt.trace, doubt.fault));
      }
    }
  });
  EXPECT_GT(named, 1000u);
}

/// Two contacts farther apart than a target is wide, by a robot that imagines none: coarse cells can't tell, fine parts
/// of them can.
TEST(WeighedCells, WhereNoPartIsPossibleTheGoalIsNotReachedAndThereIsSomethingToPlanOn) {
  const auto never_imagines =
      small_model(belief::Kind::particles, {.most_cells = 100, .sensing = {.missed_contacts = 0.05}});
  const action::Task& task = *never_imagines->task;
  int without_parts = 0;
  for (const double apart : {0.060, 0.064, 0.066, 0.068, 0.070}) {
    Belief belief(never_imagines, task.scene().start);
    for (const double side : {-0.5, 0.5}) {
      const action::Action poke = action_round(
          task, {joints({0.40, side * apart, 0.01, 0, 0, 0}), joints({0.4217, side * apart, 0.01, 0, 0, 0})});
      belief.step(poke, {true, poke.path.back()});
    }
    const std::vector<belief::Cell> cells = belief.cells().cells();
    const belief::Cell& heaviest = *std::max_element(cells.begin(), cells.end(), [&](const auto& a, const auto& b) {
      return belief.cells().weight(a) < belief.cells().weight(b);
    });
    const PoseVector& v = heaviest.centre;
    const JointVector seat = joints({v[0] - 0.013, v[1], v[2], v[3], 0, 0});
    JointVector before = seat;
    before[0] -= 0.002;
    const action::Action last = action_along(task, {before, seat});
    belief.step(last, {false, seat});
    Rng rng(1);
    const bool none = belief.weighed()->draw_parts(task, belief.history(), 200, 0.0008, rng).empty();
    without_parts += none;
    EXPECT_FALSE(none && belief.is_goal()) << apart;
    EXPECT_FALSE(belief.draw(20, rng).empty()) << apart;
  }
  EXPECT_GT(without_parts, 0);
}

/// Cells are coarse where nothing was seen yet, and a guess may be narrower than they are.
TEST(WeighedCells, WeighANarrowGuessForWhatItIs) {
  const PoseVector width{0.04, 0.08, 0.08, 0.4, 0.0, 0.0}, mean{0.455, 0.01, 0.02, 0.15, 0.0, 0.0};
  for (const double deviation : {0.01, 0.004, 0.002, 0.001}) {
    PoseVector off{deviation, deviation, deviation, 10.0 * deviation, 1.0, 1.0};
    scene::Matrix6 covariance = scene::Matrix6::Zero();
    for (int d = 0; d < 6; ++d) covariance(d, d) = off[static_cast<std::size_t>(d)] * off[static_cast<std::size_t>(d)];
    const auto guessed =
        small_model(belief::Kind::particles, {.roll_width = width[3],
                                              .position_width = width[1],
                                              .depth_width = width[0],
                                              .most_cells = 1500,
                                              .sensing = rates,
                                              .guesses = {{scene::Normal(mean, covariance, width), 0.95}}});
    const Belief belief(guessed, guessed->task->scene().start);
    double near = 0.0;
    belief.cells().for_each([&](const belief::Cell& cell) {
      const PoseVector half = belief.cells().half_width(cell);
      bool is_near = true;
      for (std::size_t d = 0; d < 4; ++d)
        is_near = is_near && std::abs(cell.centre[d] - mean[d]) <= 3.0 * off[d] + half[d];
      if (is_near) near += belief.cells().weight(cell);
    });
    EXPECT_GT(near, 0.9 * belief.cells().weight()) << deviation;
  }
}

}  // namespace
}  // namespace tactus::test
