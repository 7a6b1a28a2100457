// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>

#include "belief/plain_world.hpp"
#include "support/error.hpp"

/// What the prior's guesses change in a belief, and what they leave alone.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Cell;
using belief::CellBelief;
using support::Rng;

using Vector6 = Eigen::Matrix<double, 6, 1>;
using ModelPtr = std::shared_ptr<const belief::Model>;

constexpr double position_width = 0.04, roll_width = 0.4;

/// Two guesses, one of them narrow, with a correlation.
std::vector<scene::Guess> two_guesses() {
  const PoseVector width{0.0, position_width, position_width, roll_width, 0.0, 0.0};
  const Vector6 wide(0.01, 0.01, 0.01, 0.1, 0.1, 0.1), narrow = 0.4 * wide;
  scene::Matrix6 correlated = narrow.cwiseAbs2().asDiagonal();
  correlated(1, 3) = correlated(3, 1) = 0.8 * narrow[1] * narrow[3];
  return {{scene::Normal({0.45, -0.01, 0.02, 0.0, 0.0, 0.0}, wide.cwiseAbs2().asDiagonal(), width), 0.3},
          {scene::Normal({0.45, 0.012, 0.0, 0.2, 0.0, 0.0}, correlated, width), 0.65}};
}

ModelPtr model_with(std::vector<scene::Guess> guesses, std::size_t most_cells) {
  return small_model(belief::Kind::particles, {.roll_width = roll_width,
                                               .position_width = position_width,
                                               .most_cells = most_cells,
                                               .guesses = std::move(guesses)});
}

/// Guessed: 700 cells as a grid, and the same as a list in which some are split.
const std::vector<ModelPtr>& guessed() {
  static const std::vector<ModelPtr> made{model_with(two_guesses(), 200), model_with(two_guesses(), 3000)};
  return made;
}

/// A few observed actions; calls `after` with the belief at the start and behind each.
template <typename After>
void observe(const ModelPtr& model, std::uint64_t seed, int actions, After after) {
  Rng rng(seed);
  const action::Task& task = *model->task;
  action::ActionLibrary library(task);
  const PlainWorld world(task, geometry::pose_from(random_pose(task.scene().prior, rng)));
  Belief belief(model, task.scene().start);
  after(belief);
  for (int i = 0; i < actions; ++i) {
    const action::Action action = random_action(task, library, belief.configuration(), rng);
    belief.step(action, world.execute(action));
    after(belief);
  }
}

/// The prior's density summed over a lattice in the cell, 6 to a side.
double plain_weight(const Belief& belief, const Cell& cell) {
  constexpr int to_a_side = 6;
  const PoseVector half = belief.cells().half_width(cell);
  double sum = 0.0;
  for (int i = 0; i < to_a_side * to_a_side * to_a_side; ++i) {
    const std::array<int, 3> at{i % to_a_side, i / to_a_side % to_a_side, i / to_a_side / to_a_side};
    PoseVector v = cell.centre;
    for (std::size_t k = 0; k < 3; ++k) v[k + 1] += half[k + 1] * ((2.0 * at[k] + 1.0) / to_a_side - 1.0);
    sum += belief.task().scene().prior.density(v);
  }
  const double points = to_a_side * to_a_side * to_a_side;
  return 8.0 * half[1] * half[2] * half[3] * sum / points;
}

/// Of half a tolerance to many of them, and guesses wider and narrower than that, one with a correlation.
TEST(Weights, OfCellsAreThePriorsOverThem) {
  for (const ModelPtr& model : guessed())
    observe(model, 40, 3, [&](const Belief& belief) {
      double off = 0.0, total = 0.0;
      belief.cells().for_each([&](const Cell& cell) {
        const double plain = plain_weight(belief, cell);
        off += std::abs(belief.cells().weight(cell) - plain);
        total += plain;
      });
      EXPECT_LT(off, 0.02 * total);
    });
}

TEST(Weights, CellsAreDrawnByThem) {
  constexpr int draws = 20000;
  Rng rng(2);
  for (const ModelPtr& model : guessed())
    observe(model, 41, 3, [&](const Belief& belief) {
      const std::vector<Cell> cells = belief.cells().cells();
      std::vector<double> drawn(cells.size());
      double total = 0.0;
      for (const Cell& cell : cells) total += belief.cells().weight(cell);
      for (int i = 0; i < draws; ++i) {
        const auto at = std::find(cells.begin(), cells.end(), belief.cells().draw_cell(rng));
        ASSERT_NE(at, cells.end());
        ++drawn[static_cast<std::size_t>(at - cells.begin())];
      }
      double chi_square = 0.0, rare = 0.0, expected_rare = 0.0;
      int bins = 0;
      for (std::size_t i = 0; i < cells.size(); ++i) {
        const double expected = draws * belief.cells().weight(cells[i]) / total;
        if (expected < 8.0) {
          rare += drawn[i], expected_rare += expected;
          continue;
        }
        chi_square += (drawn[i] - expected) * (drawn[i] - expected) / expected;
        ++bins;
      }
      EXPECT_LT(chi_square, bins + 5.0 * std::sqrt(2.0 * bins));
      EXPECT_NEAR(rare, expected_rare, 1.0 + 5.0 * std::sqrt(expected_rare));
    });
}

TEST(Weights, ASummaryIsThePlainSumOverTheCells) {
  for (const ModelPtr& model : guessed())
    observe(model, 42, 4, [&](const Belief& belief) {
      const belief::Summary summary = belief.summary();
      const std::vector<Cell> cells = belief.cells().cells();
      const scene::Target& target = belief.task().scene().target;
      const std::array<double, 3> tolerances{2.0 * target.position_tolerance, 2.0 * target.position_tolerance,
                                             2.0 * target.angle_tolerance};
      using Box = std::array<std::pair<bool, double>, 3>;  // by dimension: whether it is coarse, and where it is
      struct Share {
        double weight = 0.0, tolerances = 1.0;
      };
      std::map<Box, Share> boxes;
      double total = 0.0, bits = 0.0;
      Vector6 mean = Vector6::Zero();
      scene::Matrix6 covariance = scene::Matrix6::Zero();
      PoseVector low, high, middle;
      low.fill(1e300), high.fill(-1e300);
      for (const Cell& cell : cells) {
        total += belief.cells().weight(cell);
        for (std::size_t d = 0; d < 6; ++d) {
          low[d] = std::min(low[d], cell.centre[d] - belief.cells().half_width(cell)[d]);
          high[d] = std::max(high[d], cell.centre[d] + belief.cells().half_width(cell)[d]);
          middle[d] = 0.5 * (low[d] + high[d]);
        }
      }
      for (const Cell& cell : cells) {
        const double share = belief.cells().weight(cell) / total;
        mean += share * Vector6(cell.centre.data());
        Share boxed;
        Box box;
        for (std::size_t i = 0; i < 3; ++i) {
          const std::size_t d = i + 1;
          const double width = 2.0 * belief.cells().half_width(cell)[d], wide = std::max(width, tolerances[i]);
          boxed.tolerances *= wide / tolerances[i];
          const bool is_coarse = width > tolerances[i];
          box[i] = {is_coarse,
                    is_coarse ? cell.centre[d] : std::floor((cell.centre[d] - middle[d]) / wide + 0.5 + 1e-6)};
        }
        boxes.try_emplace(box, boxed).first->second.weight += share;
      }
      for (const auto& [box, share] : boxes) bits += share.weight * std::log2(share.tolerances / share.weight);
      for (const Cell& cell : cells) {
        const PoseVector half = belief.cells().half_width(cell);
        const Vector6 off = Vector6(cell.centre.data()) - mean;
        covariance += belief.cells().weight(cell) / total * off * off.transpose();
        for (int d = 0; d < 6; ++d)
          covariance(d, d) += belief.cells().weight(cell) / total * half[static_cast<std::size_t>(d)] *
                              half[static_cast<std::size_t>(d)] / 3.0;
      }
      EXPECT_NEAR(summary.bits, std::max(0.0, bits), 1e-9);
      EXPECT_LT((Vector6(summary.mean.data()) - mean).head<3>().norm(), 1e-9);
      EXPECT_NEAR(summary.mean[3], mean[3], 2e-3) << "a circular mean, of angles close together";
      EXPECT_LT((scene::Matrix6(summary.covariance.data()) - covariance).cwiseAbs().maxCoeff(), 1e-5);
    });
}

TEST(Weights, AreOfVolumeAloneWithoutGuesses) {
  const belief::Belief belief(model_with({}, 200), model_with({}, 200)->task->scene().start);
  const CellBelief& cells = belief.cells();
  EXPECT_EQ(cells.weight(), cells.volume());
  Rng rng(3), same(3);
  for (int i = 0; i < 100; ++i) {
    const Cell drawn = cells.draw_cell(rng);
    ASSERT_EQ(drawn, cells.cells()[same.below(cells.size())]);
    ASSERT_EQ(cells.weight(drawn), cells.volume(drawn));
  }
  const scene::Target& target = belief.task().scene().target;
  EXPECT_NEAR(belief.summary().bits,
              std::log2(cells.volume() / (2.0 * target.position_tolerance * 2.0 * target.position_tolerance * 2.0 *
                                          target.angle_tolerance)),
              1e-9);
}

/// The set guarantee is of cells: however unlikely, one goes only for what was felt.
TEST(Weights, RemoveNoCell) {
  Rng rng(43);
  for (const std::size_t most_cells : {200u, 3000u}) {
    const ModelPtr guess = model_with(two_guesses(), most_cells), none = model_with({}, most_cells);
    const action::Task& task = *guess->task;
    action::ActionLibrary library(task);
    const PlainWorld world(task, geometry::pose_from(random_pose(task.scene().prior, rng)));
    Belief with(guess, task.scene().start), without(none, task.scene().start);
    for (int i = 0; i < 5; ++i) {
      const action::Action action = random_action(task, library, with.configuration(), rng);
      const belief::Observation seen = world.execute(action);
      with.step(action, seen);
      without.step(action, seen);
      EXPECT_TRUE(with.cells().cells() == without.cells().cells()) << i;
    }
  }
}

TEST(Weights, LeaveFewerBitsToFindThanNoGuesses) {
  const ModelPtr guess = model_with(two_guesses(), 200), none = model_with({}, 200);
  const belief::Summary with = Belief(guess, guess->task->scene().start).summary();
  const belief::Summary without = Belief(none, none->task->scene().start).summary();
  EXPECT_LT(with.bits, without.bits - 1.0);
  for (std::size_t d = 0; d < 6; ++d) EXPECT_NEAR(with.extent[d], without.extent[d], 1e-12);
}

TEST(Weights, OfASavedBeliefAreThoseOfItsScenario) {
  for (const ModelPtr& model : guessed())
    observe(model, 44, 3, [&](const Belief& belief) {
      const std::vector<std::uint8_t> bytes = belief.save();
      const Belief again = Belief::restore(model, bytes.data(), bytes.size());
      Rng rng(5), same(5);
      for (int i = 0; i < 50; ++i) ASSERT_EQ(belief.cells().draw_cell(rng), again.cells().draw_cell(same));
    });
}

TEST(Weights, ASavedBeliefIsNotTakenByAScenarioWithOthers) {
  const ModelPtr model = guessed().front();
  const std::vector<std::uint8_t> bytes = Belief(model, model->task->scene().start).save();
  std::vector<scene::Guess> likelier = two_guesses(), elsewhere = two_guesses(), surer = two_guesses(),
                            one = two_guesses();
  const scene::Normal& normal = one[0].normal;
  const PoseVector& width = model->task->scene().prior.width;
  PoseVector aside = normal.mean();
  aside[1] += 0.001;
  likelier[0].share = 0.31;
  elsewhere[0].normal = scene::Normal(aside, normal.covariance(), width);
  surer[0].normal = scene::Normal(normal.mean(), 0.9 * normal.covariance(), width);
  one.pop_back();
  for (const auto& guesses : {std::vector<scene::Guess>{}, likelier, elsewhere, surer, one}) {
    try {
      Belief::restore(model_with(guesses, 200), bytes.data(), bytes.size());
      ADD_FAILURE();
    } catch (const support::Error& error) {
      EXPECT_EQ(error.status(), support::Status::wrong_scenario);
    }
  }
  EXPECT_NO_THROW(Belief::restore(model_with(two_guesses(), 200), bytes.data(), bytes.size()));
}

}  // namespace
}  // namespace tactus::test
