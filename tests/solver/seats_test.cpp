// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <set>

#include "belief/small_task.hpp"
#include "solver/greedy.hpp"
#include "solver/pose_problem.hpp"
#include "solver/search.hpp"

/// A square pin fits a square hole in four ways: what differs by a quarter turn need not be told apart.
namespace tactus::test {
namespace {

using solver::BeliefStatePtr;
using solver::Choice;
using support::Rng;
using TaskPtr = std::shared_ptr<const action::Task>;

constexpr double quarter_turn = 0.5 * std::numbers::pi;

TaskPtr task(int seats) { return small_task({.roll_width = 2.0 * std::numbers::pi, .seats = seats}); }

Pose rolled(double y, double roll) { return geometry::pose_from({0.45, y, 0.01, roll, 0.0, 0.0}); }

/// One socket, known but for a number of quarter turns.
std::vector<Pose> alike(double y = 0.0) {
  std::vector<Pose> poses;
  for (int turns = -2; turns < 2; ++turns) poses.push_back(rolled(y, 0.1 + turns * quarter_turn));
  return poses;
}

BeliefStatePtr start(const TaskPtr& task, const std::vector<Pose>& poses) {
  return std::make_shared<solver::PoseProblem>(task, std::make_shared<action::ActionLibrary>(*task),
                                               std::make_shared<solver::Predictions>(task, poses), 2.0, 0.035)
      ->start(task->scene().start);
}

bool finishes(const Choice& choice) {
  return std::all_of(choice.outcomes.begin(), choice.outcomes.end(), [](const auto& outcome) { return outcome.goal; });
}

/// What the paper's search would do first.
Choice planned(const BeliefStatePtr& belief) {
  solver::Search search(belief, {});
  support::Deadline deadline(std::numeric_limits<double>::infinity(), 20);
  search.run(deadline);
  return search.choices(solver::Search::start).at(search.best(solver::Search::start).value());
}

TEST(Seats, PosesThatDifferByTheSymmetryAreAllTheGoal) {
  const TaskPtr four = task(4), one = task(1);
  const Pose base_from_tool = four->scene().seated(rolled(0.0, 0.1));
  int seated = 0;
  for (const Pose& pose : alike()) {
    EXPECT_TRUE(four->scene().is_seated(base_from_tool, pose));
    seated += one->scene().is_seated(base_from_tool, pose);
  }
  EXPECT_EQ(seated, 1);
}

TEST(Seats, OneAttemptFinishesWhateverTheNumberOfQuarterTurns) {
  const BeliefStatePtr belief = start(task(4), alike());
  const Choice choice = planned(belief);
  EXPECT_EQ(choice.motion->kind, action::Kind::insertion);
  EXPECT_TRUE(finishes(choice));
  const std::vector<Choice> choices = belief->choices(support::Deadline::unlimited());
  for (const solver::Greedy rule : {solver::Greedy::tbl, solver::Greedy::frontier, solver::Greedy::rate})
    EXPECT_TRUE(finishes(choices.at(solver::greedy_choice(choices, rule).value())));
}

TEST(Seats, WithOneSeatNoAttemptFinishesThem) {
  const std::vector<Choice> choices = start(task(1), alike())->choices(support::Deadline::unlimited());
  EXPECT_FALSE(std::any_of(choices.begin(), choices.end(), finishes));
}

TEST(Seats, AnAttemptIsAtTheNearest) {
  const TaskPtr four = task(4);
  const scene::Scene& scene = four->scene();
  for (const double roll : {0.1, 1.2, 2.4, -2.0}) {
    const Choice choice = planned(start(four, {rolled(0.0, roll)}));
    ASSERT_TRUE(finishes(choice));
    const Pose seat = four->base_from_tool(choice.motion->path.back());
    EXPECT_LE(geometry::angle_between(seat, four->base_from_tool(scene.start)), 0.5 * quarter_turn + 1e-6);
  }
}

TEST(Seats, EveryGroupOfPosesHasItsAttempt) {
  std::vector<Pose> poses = alike(-0.004);
  for (const Pose& pose : alike(0.004)) poses.push_back(pose);
  std::set<double> sides;
  for (const Choice& choice : start(task(4), poses)->choices(support::Deadline::unlimited()))
    if (choice.motion->kind == action::Kind::insertion)
      sides.insert(std::round(1000.0 * choice.motion->supposed_target.translation().y()));
  EXPECT_EQ(sides, (std::set<double>{-4.0, 4.0}));
}

TEST(Seats, TheHeuristicIsOfTheBestSeat) {
  Rng rng(1);
  const TaskPtr four = task(4), one = task(1);
  int lower = 0;
  for (int i = 0; i < 20; ++i) {
    const Pose pose = four->scene().prior.sample(rng);
    const BeliefStatePtr belief = start(four, {pose});
    const double bound = belief->heuristic()[0];
    EXPECT_LE(bound, start(one, {pose})->heuristic()[0]);
    lower += bound < start(one, {pose})->heuristic()[0];
    for (const Choice& choice : belief->choices(support::Deadline::unlimited()))
      if (finishes(choice)) {
        EXPECT_LE(bound, choice.expected_cost());
      }
  }
  EXPECT_GT(lower, 5);
}

}  // namespace
}  // namespace tactus::test
