// SPDX-License-Identifier: BSD-3-Clause
#include "solver/planner.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>
#include <limits>
#include <thread>

#include "solver/forecast.hpp"
#include "solver/planner_setting.hpp"
#include "support/error.hpp"

/// A planner as its callers see it: options, budgets, answers, and the policy it follows.
namespace tactus::test {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::string refusal(const PlannerOptions& options) {
  try {
    Planner planner(model(Kind::particles), options);
  } catch (const support::Error& error) {
    EXPECT_EQ(error.status(), support::Status::invalid_argument);
    return error.what();
  }
  return "";
}

/// A free motion to and fro: the belief is as before but for what it has been through.
void detour(Belief& belief) {
  const JointVector q = belief.configuration(), back = q - joints({0.002, 0, 0, 0, 0, 0});
  belief.step(action_along(*task(), {q, back, q}), {false, q});
}

TEST(PlannerOptions, OutOfRangeAreRefusedByName) {
  EXPECT_EQ(refusal(within(1)), "");
  for (const double bad : {0.0, -1.0, nan})
    EXPECT_NE(refusal({.budget_seconds = bad}).find("budget_seconds"), std::string::npos);
  for (const double bad : {-0.1, 1.1, nan}) EXPECT_NE(refusal({.epsilon = bad}).find("epsilon"), std::string::npos);
  for (const int bad : {0, -2}) EXPECT_NE(refusal({.horizon = bad}).find("horizon"), std::string::npos);
  EXPECT_NE(refusal(within(0)).find("no budget"), std::string::npos);
  EXPECT_NE(refusal({.solver = Solver{8}}).find("solver"), std::string::npos);
}

TEST(SolverNames, LeadBackToTheirSolvers) {
  for (const Solver solver : solvers) EXPECT_EQ(solver::solver_from(solver::name_of(solver)), solver);
  EXPECT_EQ(solver::solver_from("rtdp"), std::nullopt);
}

TEST(Query, HandsOutAFreeActionFromWhereTheRobotIsWithinItsExpansions) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    for (const Solver solver : solvers)
      for (const std::uint64_t budget : {1, 6}) {
        const Belief belief(model(kind), task()->scene().start);
        Planner planner(model(kind), within(budget, solver));
        const Answer answer = planner.query(belief);
        ASSERT_EQ(answer.kind, Answer::Kind::action) << solver::name_of(solver);
        EXPECT_EQ(answer.action->path.front(), belief.configuration());
        for (const JointVector& q : answer.action->path) EXPECT_TRUE(task()->known_world().is_free(q));
        EXPECT_GT(answer.action->expected_cost, 0.0);
        EXPECT_GE(answer.action->contact_probability, 0.0);
        EXPECT_LE(answer.action->contact_probability, 1.0);
        const solver::PlannerStatistics& took = planner.statistics();
        EXPECT_GE(took.expansions, 1u);
        EXPECT_LE(took.expansions, budget);
        EXPECT_EQ(took.total_calls, 1u);
        EXPECT_EQ(took.total_expansions, took.expansions);
        EXPECT_LE(took.lower_bound, took.value + 1e-9);
        EXPECT_FALSE(took.from_policy);
      }
}

TEST(Query, HandsOutAnActionHoweverLittleTimeThereIs) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    for (const Solver solver : solvers) {
      Rng rng(29);
      const PlainWorld world(*task(), task()->scene().prior.sample(rng));
      Belief belief(model(kind), task()->scene().start);
      Planner planner(model(kind), {.solver = solver, .budget_seconds = 1e-6});
      for (int i = 0; i < 3 && !belief.is_goal(); ++i) {
        const Answer answer = planner.query(belief);
        ASSERT_EQ(answer.kind, Answer::Kind::action) << solver::name_of(solver) << ", action " << i;
        EXPECT_LE(planner.statistics().lower_bound, planner.statistics().value + 1e-9);
        belief.step(*answer.action, world.execute(*answer.action));
      }
    }
}

TEST(Query, GivesTheSameActionsForTheSameSeedAndExpansions) {
  Rng rng(1);
  const PlainWorld world(*task(), task()->scene().prior.sample(rng));
  Belief belief(model(Kind::particles), task()->scene().start);
  Planner first(model(Kind::particles), within(10)), second(model(Kind::particles), within(10));
  for (int i = 0; i < 6; ++i) {
    const Answer one = first.query(belief), other = second.query(belief);
    ASSERT_EQ(one.kind, other.kind);
    if (one.kind != Answer::Kind::action) break;
    EXPECT_EQ(one.action->id, other.action->id);
    EXPECT_EQ(first.statistics().from_policy, second.statistics().from_policy);
    belief.step(*one.action, world.execute(*one.action));
  }
}

TEST(Query, GivesTheSameActionsWhateverTheNumberOfThreads) {
  for (const Kind kind : {Kind::hierarchical, Kind::particles})
    for (const Solver solver : {Solver::rtdp_bel, Solver::brtdp_bel, Solver::rate}) {
      belief::Options options = model(kind)->options;
      options.cells.threads = 3;
      const auto by_three = std::make_shared<const belief::Model>(task(), options);
      Rng rng(17);
      const PlainWorld world(*task(), task()->scene().prior.sample(rng));
      Belief one(model(kind), task()->scene().start), three(by_three, task()->scene().start);
      Planner planner_of_one(model(kind), within(3, solver)), planner_of_three(by_three, within(3, solver));
      for (int i = 0; i < 6; ++i) {
        const Answer answer = planner_of_one.query(one), other = planner_of_three.query(three);
        ASSERT_EQ(answer.kind, other.kind);
        if (!answer.action) break;
        ASSERT_EQ(answer.action->id, other.action->id) << solver::name_of(solver) << ", action " << i;
        one.step(*answer.action, world.execute(*answer.action));
        three.step(*other.action, world.execute(*other.action));
      }
    }
}

TEST(Query, SaysSoAtTheGoal) {
  const Pose truth = task()->scene().prior.central_pose();
  const PlainWorld world(*task(), truth);
  action::ActionLibrary library(*task());
  Belief belief(model(Kind::particles), task()->scene().start);
  const action::Action in = insertion_at(*task(), library, belief.configuration(), truth);
  belief.step(in, world.execute(in));
  ASSERT_TRUE(belief.is_goal());
  Planner planner(model(Kind::particles), within(10));
  const Answer answer = planner.query(belief);
  EXPECT_EQ(answer.kind, Answer::Kind::goal_reached);
  EXPECT_EQ(answer.action, nullptr);
  EXPECT_EQ(planner.statistics().total_calls, 0u);
}

/// Runs episodes in which two planners are asked alike, and calls `visit(first, second, earlier, action, seen, belief)`
/// wherever the first goes on with its policy.
template <typename Visit>
int for_followed(Visit&& visit) {
  int times = 0;
  Rng rng(3);
  for (int episode = 0; episode < 4; ++episode) {
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner first(model(Kind::particles), within(12)), second(model(Kind::particles), within(12));
    Answer answer = first.query(belief);
    second.query(belief);
    for (int i = 0; i < 6 && answer.kind == Answer::Kind::action; ++i) {
      const Belief earlier = belief;
      const belief::Observation seen = world.execute(*answer.action);
      belief.step(*answer.action, seen);
      const action::ActionPtr taken = answer.action;
      const std::uint64_t calls = first.statistics().total_calls;
      answer = first.query(belief);
      EXPECT_EQ(first.statistics().total_calls, calls + (first.statistics().from_policy ? 0 : 1));
      if (first.statistics().from_policy) {
        ++times;
        EXPECT_EQ(answer.action->path.front(), belief.configuration());
        EXPECT_EQ(first.statistics().expansions, 0u);
        visit(second, earlier, *taken, seen);
        break;
      }
      second.query(belief);
    }
  }
  return times;
}

TEST(Policy, IsFollowedByNoBeliefThatHasBeenThroughSomethingElse) {
  const int followed =
      for_followed([](Planner& planner, Belief other, const action::Action& taken, const belief::Observation& seen) {
        detour(other);
        other.step(taken, seen);
        ASSERT_EQ(planner.query(other).kind, Answer::Kind::action);
        EXPECT_FALSE(planner.statistics().from_policy);
      });
  EXPECT_GT(followed, 1);
}

TEST(Policy, IsNotFollowedByAnotherOutcome) {
  for_followed([](Planner& planner, Belief other, const action::Action& taken, const belief::Observation&) {
    other.step(taken, {false, taken.path.front()});  // halted at once
    planner.query(other);
    EXPECT_FALSE(planner.statistics().from_policy);
  });
}

TEST(Policy, IsNotMixedUpBetweenTwoBeliefs) {
  Rng rng(4);
  const PlainWorld one(*task(), task()->scene().prior.sample(rng)), other(*task(), task()->scene().prior.sample(rng));
  std::array<Belief, 2> beliefs{Belief(model(Kind::particles), task()->scene().start),
                                Belief(model(Kind::particles), task()->scene().start)};
  detour(beliefs[1]);
  Planner planner(model(Kind::particles), within(12));
  for (int i = 0; i < 10; ++i) {
    Belief& belief = beliefs[i % 2];
    const Answer answer = planner.query(belief);
    EXPECT_FALSE(planner.statistics().from_policy);
    if (answer.kind != Answer::Kind::action) break;
    ASSERT_EQ(answer.action->path.front(), belief.configuration());
    belief.step(*answer.action, (i % 2 == 0 ? one : other).execute(*answer.action));
  }
}

TEST(Cancel, EndsAQueryThatHasNoBudgetToSpend) {
  const Belief belief(model(Kind::hierarchical), task()->scene().start);
  Planner planner(model(Kind::hierarchical), within(UINT64_MAX));
  std::atomic<bool> done{false};
  Answer answer;
  std::thread running([&] {
    answer = planner.query(belief);
    done = true;
  });
  while (!done) {
    planner.cancel();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  running.join();
  EXPECT_TRUE(answer.kind == Answer::Kind::action || answer.kind == Answer::Kind::cancelled);
  EXPECT_EQ(answer.action != nullptr, answer.kind == Answer::Kind::action);
}

TEST(Cancel, AtAnyTimeLeavesAPlannerThatPlans) {
  Rng rng(5);
  const PlainWorld world(*task(), task()->scene().prior.sample(rng));
  for (const Solver solver : {Solver::brtdp_bel, Solver::rtdp_bel, Solver::rate}) {
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(4, solver));
    for (int steps = 0; steps < 6; ++steps) {
      std::atomic<bool> done{false};
      std::thread running([&] {
        const Answer answer = planner.query(belief);
        EXPECT_EQ(answer.action != nullptr, answer.kind == Answer::Kind::action);
        done = true;
      });
      std::this_thread::sleep_for(std::chrono::duration<double>(rng.uniform(0.0, 0.1)));
      for (; !done; std::this_thread::sleep_for(std::chrono::milliseconds(1))) planner.cancel();
      running.join();
      const Answer answer = planner.query(belief);
      if (answer.kind != Answer::Kind::action) break;
      ASSERT_EQ(answer.action->path.front(), belief.configuration());
      ASSERT_GT(answer.action->path.size(), 1u);
      belief.step(*answer.action, world.execute(*answer.action));
    }
  }
}

/// What has its action from an earlier call only makes the way to it then, which takes milliseconds.
TEST(Cancel, WhileAPolicyIsFollowedIsAnAnswerToo) {
  Rng rng(6);
  int cancelled = 0;
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    Trial trial(seed, within(60));
    auto& [world, belief, planner] = trial;
    for (int steps = 0; steps < 8; ++steps) {
      std::future<Answer> running =
          std::async(std::launch::async, [&planner, &belief] { return planner.query(belief); });
      std::this_thread::sleep_for(std::chrono::duration<double>(rng.uniform(0.0, 0.0005)));
      planner.cancel();
      ASSERT_NO_THROW(cancelled += running.get().kind == Answer::Kind::cancelled);
      const Answer answer = planner.query(belief);
      if (answer.kind != Answer::Kind::action) break;
      belief.step(*answer.action, world.execute(*answer.action));
    }
  }
  EXPECT_GT(cancelled, 10);
}

TEST(Cancel, WithoutAQueryChangesNothing) {
  const Belief belief(model(Kind::particles), task()->scene().start);
  Planner calm(model(Kind::particles), within(10)), cancelled(model(Kind::particles), within(10));
  cancelled.cancel();
  EXPECT_EQ(calm.query(belief).action->id, cancelled.query(belief).action->id);
  EXPECT_EQ(calm.statistics().expansions, cancelled.statistics().expansions);
}

/// Were its poses drawn from the sequence that begins with its seed, they would be those that whoever draws the true
/// pose by the same seed gets first.
TEST(Chance, OfAPlannerIsItsOwn) {
  const Belief belief(model(Kind::hierarchical), task()->scene().start);
  int differ = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    PlannerOptions options = within(1);
    options.seed = seed;
    Planner planner(model(Kind::hierarchical), options);
    const Answer answer = planner.query(belief);
    ASSERT_TRUE(answer.action);
    Rng rng(seed);
    const std::vector<double> by_seed = solver::forecast(belief, *answer.action, belief::Likelihood::calibrated, rng);
    differ += std::abs(1.0 - by_seed.back() - answer.action->contact_probability) > 1e-9;
  }
  EXPECT_GT(differ, 2);
}

TEST(Query, PlansOnAFewPosesHoweverFewAreAskedFor) {
  int after_a_contact = 0;
  for (const std::size_t particles : {1u, 3u})
    for (const Solver solver : {Solver::brtdp_bel, Solver::rtdp_bel, Solver::rate}) {
      belief::Options options = model(Kind::particles)->options;
      options.particles = particles;
      const auto few = std::make_shared<const belief::Model>(task(), options);
      Planner planner(few, within(2, solver));
      Belief belief(few, task()->scene().start);
      const PlainWorld world(*task(), task()->scene().prior.central_pose());
      for (int i = 0; i < 6; ++i) {
        const Answer answer = planner.query(belief);
        if (answer.kind != Answer::Kind::action) break;
        after_a_contact += belief::has_met_something(belief.history());
        belief.step(*answer.action, world.execute(*answer.action));
        Rng rng(static_cast<std::uint64_t>(i));
        EXPECT_FALSE(belief.draw(particles, rng).empty());
      }
    }
  EXPECT_GT(after_a_contact, 5);
}

/// Nothing was done in between, whether observations contradict each other or not.
TEST(Query, AskedAgainSetsNothingAside) {
  Belief belief(model(Kind::particles), task()->scene().start);
  const JointVector q = belief.configuration(), aside = q - joints({0.002, 0, 0, 0, 0, 0});
  belief.step(action_along(*task(), {q, aside}), {true, aside});
  ASSERT_EQ(belief.health(), belief::Health::contradicted);
  Planner planner(model(Kind::particles), within(2, Solver::rate));
  for (int i = 0; i < 8; ++i) {
    ASSERT_EQ(planner.query(belief).kind, Answer::Kind::action);
    for (const solver::Alternative& alternative : planner.alternatives())
      EXPECT_NE(alternative.verdict, solver::Verdict::set_aside) << i;
  }
}

}  // namespace
}  // namespace tactus::test
