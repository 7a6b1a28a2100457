// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "solver/planner_setting.hpp"

/// A planner as the search goes on: what it does where the belief does not shrink, and where it is contradicted.
namespace tactus::test {
namespace {

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
    Trial trial(seed, within(2, Solver::brtdp_bel));
    auto& [world, belief, planner] = trial;
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
/// knows: so from a contact it goes back a little, and farther each time it is halted, whether or not it turns about
/// and makes small moves there in between.
TEST(Stuck, GoesBackAsItCameBeforeItSetsOutForAnythingElse) {
  constexpr double back_off = 0.01, farther = 3.0;
  int stuck = 0;
  for (const std::uint64_t seed : {10u, 11u, 12u, 13u, 14u, 15u}) {
    const bool small_motions_are_free = seed > 12;
    Trial trial(seed, within(6));
    auto& [world, belief, planner] = trial;
    ASSERT_NO_FATAL_FAILURE(act_until_contact(planner, world, belief));
    for (int i = 0, halts = 0; i < 14; ++i) {
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      const bool is_anchored = chosen_by(planner).motion->anchored;
      if (is_anchored && (belief.history().back().contact || halts > 0)) {
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
      const bool is_halted = is_anchored || !small_motions_are_free;
      halts += is_halted;
      belief.step(*answer.action, {false, is_halted ? belief.configuration() : answer.action->path.back()});
    }
  }
  EXPECT_GT(stuck, 12);
}

/// A robot that goes on where it was stopped and feels nothing errs: it may travel on after contacts, and goes back
/// farther after the next.
TEST(Contradicted, HasTheRobotGoBackFarther) {
  int contradicted = 0, farther = 0;
  for (std::uint64_t seed = 14; seed < 34 && contradicted < 2; ++seed) {
    Trial trial(seed, within(4));
    auto& [world, belief, planner] = trial;
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

bool is_small_and_tells_nothing(const solver::Choice& choice) {
  return !choice.motion->anchored && choice.information() <= 0.1 && choice.goal_probability() == 0.0;
}

double bits_per_cost(const solver::Choice& choice) { return choice.information() / (choice.expected_cost() + 0.02); }

/// What it hands out tells enough beside all that it might have handed out, or is likely to be the last. So there is
/// hardly ever a small motion that is to tell nothing, and never a second one in a row as long as there is anything
/// else.
TEST(Bounded, MakesNoMotionThatTellsMuchLessForItsCostThanAnotherOnceSomethingWasMet) {
  int asked = 0, beaten_by_cost = 0;
  for (std::uint64_t seed = 60; seed < 72; ++seed) {
    Trial trial(seed, within(40, Solver::brtdp_bel));
    auto& [world, belief, planner] = trial;
    ASSERT_NO_FATAL_FAILURE(act_until_contact(planner, world, belief));
    double bits = 1e300;
    bool was_idle = false;
    for (int i = 0; i < 10; ++i) {
      const double now = std::log2(belief.cells().weight());
      const bool shrank = now < bits - 0.1;
      if (shrank) bits = now;
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      const solver::Choice& chosen = chosen_by(planner);
      for (const solver::Alternative& other : planner.alternatives()) {
        if (other.verdict != solver::Verdict::passed_over) continue;
        ++asked;
        EXPECT_TRUE(chosen.goal_probability() > 0.5 || bits_per_cost(chosen) >= 0.6 * bits_per_cost(other.choice))
            << "seed " << seed << ", action " << i;
        beaten_by_cost += bits_per_cost(chosen) < bits_per_cost(other.choice);
      }
      const bool is_idle = is_small_and_tells_nothing(chosen);
      EXPECT_FALSE(was_idle && !shrank && is_idle) << "seed " << seed << ", action " << i;
      was_idle = is_idle;
      belief.step(*answer.action, world.execute(*answer.action));
    }
  }
  EXPECT_GT(asked, 100);
  EXPECT_GT(beaten_by_cost, 10) << "among those that tell enough the upper bound decides";
}

/// An attempt may meet nothing and not be the last, where the target may be deeper than it was supposed.
TEST(Stuck, MakesNoSecondAttemptWhereOneMetNothing) {
  const auto deep = small_task({.roll_width = 0.02, .position_width = 0.002, .depth_width = 0.03});
  const auto in_depth = std::make_shared<const belief::Model>(deep, model(Kind::particles)->options);
  const scene::Target& target = deep->scene().target;
  int asked = 0;
  for (std::uint64_t seed = 80; seed < 86; ++seed) {
    Belief belief(in_depth, deep->scene().start);
    Planner planner(in_depth,
                    {.solver = Solver::rate, .budget_seconds = infinity, .budget_expansions = 3, .seed = seed});
    std::vector<Pose> gone_in;
    for (int i = 0; i < 8 && belief.health() == belief::Health::good; ++i) {
      const Answer answer = planner.query(belief);
      if (!answer.action) break;
      const JointVector end = answer.action->path.back();
      belief.step(*answer.action, {false, end});
      if (answer.action->kind != action::Kind::insertion) continue;
      const Pose seated = deep->base_from_tool(end);
      for (const Pose& earlier : gone_in) {
        ++asked;
        EXPECT_FALSE((seated.translation() - earlier.translation()).norm() < 0.5 * target.position_tolerance &&
                     geometry::angle_between(seated, earlier) < 0.5 * target.angle_tolerance)
            << "seed " << seed << ", action " << i;
      }
      gone_in.push_back(seated);
    }
  }
  EXPECT_GT(asked, 5);
}

/// What was met without avail is not sought again.
TEST(Stuck, SeeksNoContactLikeTheLastThatToldNothing) {
  int asked = 0;
  for (std::uint64_t seed = 15; seed < 31; ++seed) {
    Trial trial(seed, within(4));
    auto& [world, belief, planner] = trial;
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
    Trial trial(seed, within(3, Solver::rate));
    auto& [world, belief, planner] = trial;
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

}  // namespace
}  // namespace tactus::test
