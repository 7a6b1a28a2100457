// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "solver/planner_setting.hpp"

/// What a planner says it weighed: laws for every solver, on voxels and on poses, along whole episodes.
namespace tactus::test {
namespace {

using solver::Alternative;
using solver::Verdict;

constexpr std::size_t delta = 1000;  // voxels: the hand-over comes on the way
constexpr std::uint64_t budget = 8;  // expansions

/// Calls `visit(belief, planner, answer, solver)` after every query of an episode with each solver and kind of belief.
template <typename Visit>
void for_queries(Visit&& visit) {
  Rng rng(5);
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    for (const Solver solver : solvers) {
      SCOPED_TRACE(solver::name_of(solver));
      const PlainWorld world(*task(), task()->scene().prior.sample(rng));
      const Model searched = made_model(kind, delta);
      Belief belief(searched, task()->scene().start);
      Planner planner(searched, within(budget, solver));
      for (int i = 0; i < 8; ++i) {
        const Answer answer = planner.query(belief);
        ASSERT_NO_FATAL_FAILURE(visit(belief, planner, answer, solver));
        if (!answer.action) break;
        belief.step(*answer.action, world.execute(*answer.action));
      }
    }
}

std::size_t count(const std::vector<Alternative>& alternatives, Verdict verdict) {
  return static_cast<std::size_t>(std::count_if(alternatives.begin(), alternatives.end(),
                                                [&](const Alternative& a) { return a.verdict == verdict; }));
}

bool could_be(const Alternative& alternative) {
  return alternative.verdict == Verdict::chosen || alternative.verdict == Verdict::passed_over;
}

TEST(Alternatives, HoldTheActionThatWasHandedOutAndItIsTheFirstThatCouldBe) {
  std::size_t compared = 0, set_aside = 0;
  for_queries([&](const Belief&, const Planner& planner, const Answer& answer, Solver) {
    const std::vector<Alternative>& weighed = planner.alternatives();
    ASSERT_EQ(weighed.empty(), answer.action == nullptr);
    if (!answer.action) return;
    ASSERT_EQ(count(weighed, Verdict::chosen), 1u);
    const auto chosen = std::find_if(weighed.begin(), weighed.end(), could_be);
    ASSERT_EQ(chosen->verdict, Verdict::chosen);
    ASSERT_EQ(chosen->choice.motion->kind, answer.action->kind);
    ASSERT_EQ(chosen->choice.motion->path.back(), answer.action->path.back());
    ASSERT_EQ(chosen->choice.contact_probability(), answer.action->contact_probability);
    ASSERT_EQ(chosen->q[1], answer.action->expected_cost);
    compared += weighed.size() - 1;
    set_aside += count(weighed, Verdict::set_aside);
  });
  EXPECT_GT(compared, 1000u);
  EXPECT_GT(set_aside, 0u);
}

TEST(Alternatives, AreInTheOrderInWhichTheSolverWouldTakeThem) {
  for_queries([&](const Belief&, const Planner& planner, const Answer&, Solver solver) {
    const std::vector<Alternative>& weighed = planner.alternatives();
    const auto rule = solver::greedy_of(solver);
    for (std::size_t i = 1; i < weighed.size(); ++i) {
      const Alternative &better = weighed[i - 1], &worse = weighed[i];
      const std::size_t by = solver == Solver::rtdp_ad ? 0 : 1;
      if (rule)
        ASSERT_GE(solver::merit_of(better.choice, *rule, 0.0), solver::merit_of(worse.choice, *rule, 0.0));
      else
        ASSERT_LE(better.q[by], worse.q[by]);
    }
  });
}

TEST(Alternatives, OutcomesAreADistributionAndValuesTakeInTheMotion) {
  for_queries([&](const Belief&, const Planner& planner, const Answer&, Solver) {
    for (const Alternative& alternative : planner.alternatives()) {
      double total = 0.0;
      for (const solver::Outcome& outcome : alternative.choice.outcomes) total += outcome.probability;
      ASSERT_NEAR(total, 1.0, 1e-9);
      ASSERT_LE(alternative.choice.goal_probability(), 1.0 + 1e-9);
      for (const double q : alternative.q) ASSERT_GE(q, alternative.choice.expected_cost() - 1e-12);
    }
  });
}

TEST(Alternatives, BoundsAreInOrderOnPoses) {
  std::size_t bounds = 0;
  for_queries([&](const Belief& belief, const Planner& planner, const Answer&, Solver solver) {
    if (solver != Solver::brtdp_bel || belief.phase() != belief::Phase::poses) return;
    for (const Alternative& alternative : planner.alternatives()) {
      ASSERT_LE(alternative.q[0], alternative.q[1] + 1e-9);
      ++bounds;
    }
  });
  EXPECT_GT(bounds, 100u);
}

TEST(Alternatives, AskedForChangeNothing) {
  Rng rng(6);
  const Model& poses = model(Kind::particles);
  for (const Solver solver : solvers) {
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(poses, task()->scene().start);
    Planner asked(poses, within(budget, solver)), silent(poses, within(budget, solver));
    for (int i = 0; i < 8; ++i) {
      const Answer one = asked.query(belief), other = silent.query(belief);
      ASSERT_EQ(one.kind, other.kind);
      ASSERT_EQ(asked.statistics().from_policy, silent.statistics().from_policy);
      if (!one.action) break;
      ASSERT_EQ(one.action->id, other.action->id);
      const auto* first = asked.alternatives().data();
      ASSERT_EQ(asked.alternatives().data(), first) << "worked out once";
      belief.step(*one.action, world.execute(*one.action));
    }
  }
}

}  // namespace
}  // namespace tactus::test
