// SPDX-License-Identifier: BSD-3-Clause
#include "solver/planner.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <thread>

#include "belief/plain_world.hpp"
#include "solver/forecast.hpp"
#include "support/error.hpp"

/// A planner as its callers see it: options, budgets, answers, and the policy it follows.
namespace tactus::test {
namespace {

using belief::Belief;
using belief::Kind;
using solver::Answer;
using solver::Planner;
using solver::PlannerOptions;
using solver::Solver;
using support::Rng;
using Model = std::shared_ptr<const belief::Model>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::array solvers{Solver::rtdp_bel, Solver::rtdp_inad, Solver::rtdp_ad, Solver::brtdp_bel,
                             Solver::tbl,      Solver::frontier,  Solver::rate};

const std::shared_ptr<const action::Task>& task() {
  static const auto made = small_task({.roll_width = 0.2, .position_width = 0.04});
  return made;
}

Model made_model(Kind kind) {
  belief::Options options;
  options.kind = kind;
  options.voxel_size = 0.005;
  options.delta = 0;
  options.cells.most = 300;
  options.particles = 40;
  return std::make_shared<const belief::Model>(task(), options);
}

const Model& model(Kind kind) {
  static const Model voxels_first = made_model(Kind::hierarchical), poses = made_model(Kind::particles);
  return kind == Kind::hierarchical ? voxels_first : poses;
}

PlannerOptions within(std::uint64_t expansions, Solver solver = Solver::rtdp_bel) {
  return {.solver = solver, .budget_seconds = infinity, .budget_expansions = expansions};
}

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

TEST(Cancel, WithoutAQueryChangesNothing) {
  const Belief belief(model(Kind::particles), task()->scene().start);
  Planner calm(model(Kind::particles), within(10)), cancelled(model(Kind::particles), within(10));
  cancelled.cancel();
  EXPECT_EQ(calm.query(belief).action->id, cancelled.query(belief).action->id);
  EXPECT_EQ(calm.statistics().expansions, cancelled.statistics().expansions);
}

/// What one belief was down to is not what another has to beat.
TEST(Progress, IsOfOneBeliefAlone) {
  const PlainWorld world(*task(), task()->scene().prior.central_pose());
  const auto m = model(Kind::particles);
  Planner used(m, within(10)), fresh(m, within(10));
  action::ActionLibrary library(*task());
  Belief narrow(m, task()->scene().start);
  const action::Action in =
      insertion_at(*task(), library, narrow.configuration(), task()->scene().prior.central_pose());
  narrow.step(in, world.execute(in));
  narrow.set_configuration(task()->scene().start);
  used.query(narrow);
  Rng rng(8);
  for (Planner* planner : {&used, &fresh}) {
    int small = 0;
    for (int episode = 0; episode < 6; ++episode) {
      const PlainWorld hidden(*task(), task()->scene().prior.sample(rng));
      Belief belief(m, task()->scene().start);
      for (int i = 0; i < 6; ++i) {
        const Answer answer = planner->query(belief);
        if (!answer.action) break;
        small += answer.action->kind == action::Kind::move || answer.action->kind == action::Kind::turn;
        belief.step(*answer.action, hidden.execute(*answer.action));
      }
    }
    EXPECT_GT(small, 3) << (planner == &used ? "used" : "fresh");
  }
}

/// Asked again before anything was done, a planner does not take its own answer for one that led nowhere: small
/// motions, which it gives up when a belief stalls, stay among its answers.
TEST(Progress, IsNotLostByAskingAgain) {
  Rng rng(9);
  int small = 0;
  for (int episode = 0; episode < 6; ++episode) {
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(10));
    const Answer first = planner.query(belief);
    ASSERT_TRUE(first.action);
    belief.step(*first.action, world.execute(*first.action));
    for (int i = 0; i < 8; ++i) {
      const Answer answer = planner.query(belief);
      if (answer.kind == Answer::Kind::goal_reached) break;
      ASSERT_TRUE(answer.action);
      small += i >= 4 && (answer.action->kind == action::Kind::move || answer.action->kind == action::Kind::turn);
    }
  }
  EXPECT_GT(small, 0);
}

/// Where two ways part.
std::size_t in_common(const motion::JointPath& a, const motion::JointPath& b) {
  return static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin(), b.end()).first - a.begin());
}

double past_plane(const JointVector& q, const JointVector& start) {
  const Vector3 axis = task()->frame().base_from_search.linear().col(2);
  return axis.dot(task()->base_from_tool(q).translation() - task()->base_from_tool(start).translation());
}

void act_until_contact(Planner& planner, const PlainWorld& world, Belief& belief) {
  while (belief.history().empty() || !belief.history().back().contact) {
    const Answer answer = planner.query(belief);
    ASSERT_TRUE(answer.action);
    belief.step(*answer.action, world.execute(*answer.action));
  }
}

bool has_touched(const Belief& belief) {
  return std::any_of(belief.history().begin(), belief.history().end(),
                     [](const belief::Trace& trace) { return trace.contact; });
}

/// As long as nothing was met a robot does not turn about where it is; then it feels about what it has met.
TEST(Bounded, GoesOnUntilItMeetsSomethingAndFeelsAboutThatThen) {
  int looked = 0, felt = 0;
  for (const std::uint64_t seed : {50u, 51u, 52u}) {
    Rng rng(seed);
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(2, Solver::brtdp_bel));
    for (int i = 0; i < 6; ++i) {
      const bool is_looking = !has_touched(belief);
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      for (const solver::Alternative& alternative : planner.alternatives()) {
        const action::Motion& motion = *alternative.choice.motion;
        const bool is_near_poke = motion.kind == action::Kind::poke && !motion.anchored;
        EXPECT_FALSE(is_looking && (is_near_poke || motion.kind == action::Kind::turn));
        looked += is_looking;
        felt += is_near_poke;
      }
      belief.step(*answer.action, world.execute(*answer.action));
    }
  }
  EXPECT_GT(looked, 10);
  EXPECT_GT(felt, 10);
}

const solver::Choice& chosen_by(const Planner& planner) {
  const auto chosen = std::find_if(planner.alternatives().begin(), planner.alternatives().end(),
                                   [](const auto& a) { return a.verdict == solver::Verdict::chosen; });
  return chosen->choice;
}

double cost_of(const motion::JointPath& way) {
  return task()->cost(motion::tool_travel(*task()->scene().robot, task()->scene().tool_link, way));
}

/// A robot that is halted again and again learns nothing, but for what its belief finds by looking closer at what it
/// knows: so from a contact it goes back a little, and farther each time it is halted there.
TEST(Stuck, GoesBackAsItCameBeforeItSetsOutForAnythingElse) {
  constexpr double back_off = 0.01, farther = 6.0;
  int stuck = 0;
  for (const std::uint64_t seed : {10u, 11u, 12u}) {
    Rng rng(seed);
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(6));
    ASSERT_NO_FATAL_FAILURE(act_until_contact(planner, world, belief));
    double weight = 0.0;
    for (int i = 0, halts = 0; i < 14; ++i, ++halts) {
      if (belief.cells().weight() != weight) weight = belief.cells().weight(), halts = 0;
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      if (answer.action->kind >= action::Kind::sweep) {
        ++stuck;
        const motion::JointPath way = belief.way_back();
        const motion::JointPath& path = answer.action->path;
        const JointVector& start = path[answer.action->lead];
        const std::size_t along = in_common(way, path);
        ASSERT_GT(along, 0u);
        EXPECT_TRUE(along == way.size() || past_plane(way[along - 1], start) <= 1e-6 ||
                    cost_of({way.begin(), way.begin() + static_cast<std::ptrdiff_t>(along)}) >=
                        back_off * std::pow(farther, halts))
            << along << " of " << way.size() << ", halted " << halts << " times";
      }
      belief.step(*answer.action, {false, belief.configuration()});
    }
  }
  EXPECT_GT(stuck, 6);
}

/// A robot that goes on where it was stopped and feels nothing errs: it may travel on after contacts, and goes back
/// farther after the next.
TEST(Contradicted, HasTheRobotGoBackFarther) {
  int contradicted = 0, farther = 0;
  for (std::uint64_t seed = 14; seed < 34 && contradicted < 2; ++seed) {
    Rng rng(seed);
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(4));
    ASSERT_NO_FATAL_FAILURE(act_until_contact(planner, world, belief));
    EXPECT_EQ(belief.sensing(), action::Sensing{});
    const robot::JointVector stop = belief.history().back().path.back(), free = belief.configuration();
    const robot::JointVector beyond = stop + 0.02 * (stop - free).normalized();
    belief.step(action_along(*task(), {free, stop, beyond}), {false, beyond});
    if (belief.health() != belief::Health::contradicted) continue;  // it may have grazed the target
    ++contradicted;
    EXPECT_GT(belief.sensing().stopping_distance, 0.0);
    const Answer answer = planner.query(belief);
    ASSERT_TRUE(answer.action);
    EXPECT_EQ(answer.action->sensing, belief.sensing());
    action::Action without = *answer.action;
    without.sensing = {};
    const belief::Observation felt{true, answer.action->path.back()};
    const std::size_t last_free = belief::locate(*task(), *answer.action, felt).last_free;
    EXPECT_LE(last_free, belief::locate(*task(), without, felt).last_free);
    farther += last_free < belief::locate(*task(), without, felt).last_free;
  }
  EXPECT_EQ(contradicted, 2);
  EXPECT_GT(farther, 0);
}

/// What was met without avail is not sought again.
TEST(Stuck, SeeksNoContactLikeTheLastThatToldNothing) {
  int asked = 0;
  for (std::uint64_t seed = 15; seed < 31; ++seed) {
    Rng rng(seed);
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(4));
    ASSERT_NO_FATAL_FAILURE(act_until_contact(planner, world, belief));
    double bits = std::log2(belief.cells().weight());
    for (int i = 0; i < 8; ++i) {
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      const double now = std::log2(belief.cells().weight());
      const auto touch = solver::touch_of(belief.history().back());
      if (i > 0 && touch && now > bits - 0.1) {
        ++asked;
        EXPECT_LE(share_alike(chosen_by(planner), {*touch}), 0.9);
      }
      bits = std::min(bits, now);
      belief.step(*answer.action, world.execute(*answer.action));
    }
  }
  EXPECT_GT(asked, 4);
}

/// And if that does not help either: small motions and attempts are set aside in turn, and tried again.
TEST(Stuck, TriesEverythingAgainInTurn) {
  Rng rng(13);
  const PlainWorld world(*task(), task()->scene().prior.sample(rng));
  Belief belief(model(Kind::particles), task()->scene().start);
  Planner planner(model(Kind::particles), within(4));
  ASSERT_NO_FATAL_FAILURE(act_until_contact(planner, world, belief));
  std::vector<std::pair<bool, bool>> kept;  // whether small motions, and attempts, were
  for (int i = 0; i < 16; ++i) {
    const Answer answer = planner.query(belief);
    ASSERT_TRUE(answer.action) << i;
    bool small = false, attempts = false;
    for (const solver::Alternative& alternative : planner.alternatives()) {
      if (alternative.verdict == solver::Verdict::set_aside) continue;
      small = small || !alternative.choice.motion->anchored;
      attempts = attempts || alternative.choice.motion->kind == action::Kind::insertion;
    }
    kept.emplace_back(small, attempts);
    belief.step(*answer.action, {false, belief.configuration()});
  }
  const auto first_without_both = std::find(kept.begin(), kept.end(), std::pair(false, false));
  const auto first_without_small = std::find(first_without_both, kept.end(), std::pair(false, true));
  EXPECT_NE(first_without_small, kept.end());
  EXPECT_NE(std::find(first_without_small, kept.end(), std::pair(true, true)), kept.end());
}

/// A robot that does not err, and was stopped by something, would be stopped there again.
TEST(Stuck, DoesNotGoAgainWhereASmallMotionMetSomething) {
  int asked = 0;
  for (std::uint64_t seed = 40; seed < 52; ++seed) {
    Rng rng(seed);
    const PlainWorld world(*task(), task()->scene().prior.sample(rng));
    Belief belief(model(Kind::particles), task()->scene().start);
    Planner planner(model(Kind::particles), within(3, Solver::rate));
    std::vector<motion::JointPath> met;
    for (int i = 0; i < 14; ++i) {
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      const motion::JointPath& path = answer.action->path;
      const bool is_small = answer.action->kind < action::Kind::sweep;
      for (const motion::JointPath& way : met) {
        ++asked;
        EXPECT_FALSE(is_small && in_common(way, path) == way.size()) << "seed " << seed << ", action " << i;
      }
      belief.step(*answer.action, world.execute(*answer.action));
      const belief::Trace& last = belief.history().back();
      if (is_small && last.contact)
        met.emplace_back(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(last.outcome + 1));
    }
  }
  EXPECT_GT(asked, 20);
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

}  // namespace
}  // namespace tactus::test
