// SPDX-License-Identifier: BSD-3-Clause
#include "solver/forecast.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>

#include "belief/plain_world.hpp"
#include "solver/voxel_problem.hpp"

/// What a belief expects of an action: on voxels what the planner expects of it, on poses their shares.
namespace tactus::test {
namespace {

using belief::Kind;
using belief::Likelihood;
using support::Rng;

constexpr std::size_t particles = 60;

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task();
  return made;
}

std::shared_ptr<const belief::Model> model(Kind kind) {
  belief::Options options = small_model(task(), kind, {})->options;
  options.particles = particles;
  options.delta = 10;
  return std::make_shared<belief::Model>(task(), options);
}

/// A belief after some random actions in a random world.
belief::Belief random_belief(Kind kind, Rng& rng) {
  const PlainWorld world(*task(), task()->scene().prior.sample(rng));
  belief::Belief belief(model(kind), task()->scene().start);
  action::ActionLibrary library(*task());
  for (std::uint64_t i = rng.below(4); i > 0; --i) {
    const action::Action action = random_action(*task(), library, belief.configuration(), rng);
    belief.step(action, world.execute(action));
  }
  return belief;
}

std::vector<double> by_waypoint(const solver::Choice& choice) {
  std::vector<double> result(choice.motion->path.size() + 1, 0.0);
  for (const solver::Outcome& outcome : choice.outcomes) result[outcome.waypoint] = outcome.probability;
  return result;
}

TEST(Forecast, OnVoxelsIsWhatThePlannerExpectsOfAMoveFromHere) {
  auto library = std::make_shared<action::ActionLibrary>(*task());
  Rng rng(1);
  std::array<int, 2> compared{};
  for (int round = 0; round < 6; ++round) {
    const belief::Belief belief = random_belief(Kind::hierarchical, rng);
    if (belief.phase() != belief::Phase::voxels) continue;
    for (const Likelihood likelihood : {Likelihood::paper, Likelihood::calibrated}) {
      const bool calibrated = likelihood == Likelihood::calibrated;
      Rng draws(7);
      auto poses = calibrated ? belief::poses_of(belief.draw_feasible(particles, draws)) : std::vector<Pose>{};
      auto problem = std::make_shared<solver::VoxelProblem>(belief.shared_model(), library, std::move(poses), 0.035);
      for (const solver::Choice& choice :
           problem->start(belief.configuration(), belief.voxels())->choices(support::Deadline::unlimited())) {
        if (choice.motion->anchored) continue;
        const auto action = library->realise(belief.configuration(), *choice.motion, support::Deadline::unlimited());
        ASSERT_TRUE(action);
        Rng same_draws(7);
        const std::vector<double> found = solver::forecast(belief, *action, likelihood, same_draws);
        const std::vector<double> expected = by_waypoint(choice);
        ASSERT_EQ(found.size(), expected.size());
        for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 1e-4) << i;
        ++compared[calibrated];
      }
    }
  }
  EXPECT_GT(std::min(compared[0], compared[1]), 10);
}

TEST(Forecast, OnPosesIsTheShareOfThoseDrawn) {
  action::ActionLibrary library(*task());
  Rng rng(2);
  for (int round = 0; round < 5; ++round) {
    const belief::Belief belief = random_belief(Kind::particles, rng);
    const action::Action action = random_action(*task(), library, belief.configuration(), rng);
    Rng draws(7), same_draws(7);
    const std::vector<Pose> poses = belief::poses_of(belief.draw(particles, draws));
    std::vector<double> expected(action.path.size() + 1, 0.0);
    for (const Pose& pose : poses)
      ++expected[task()->target_contact().first_contact(action.bodies, pose).value_or(action.path.size())];
    const std::vector<double> found = solver::forecast(belief, action, Likelihood::paper, same_draws);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_NEAR(found[i], expected[i] / static_cast<double>(poses.size()), 1e-12);
    ASSERT_NEAR(std::accumulate(found.begin(), found.end(), 0.0), 1.0, 1e-12);
  }
}

TEST(VoxelProblem, IsCancelledBeforeItHasMadeItsMotions) {
  const std::atomic<bool> cancelled{true};
  const belief::Belief belief(model(Kind::hierarchical), task()->scene().start);
  const auto problem = std::make_shared<solver::VoxelProblem>(
      belief.shared_model(), std::make_shared<action::ActionLibrary>(*task()), std::vector<Pose>{}, 0.035, &cancelled);
  const solver::BeliefStatePtr start = problem->start(belief.configuration(), belief.voxels());
  EXPECT_THROW(start->choices(support::Deadline::unlimited()), support::Cancelled);
}

}  // namespace
}  // namespace tactus::test
