// SPDX-License-Identifier: BSD-3-Clause
#include "solver/rate_policy.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "action/insertion.hpp"
#include "solver/policy_setting.hpp"
#include "solver/pose_problem.hpp"
#include "solver/search.hpp"

/// What a simple policy costs: of some sets of poses, and as the upper bound of a search.
namespace tactus::test {
namespace {

using solver::BeliefStatePtr;
using solver::Search;
using solver::SecondValue;
using solver::ValueType;
using support::Deadline;

const action::CostWeights& weights() { return task()->options().cost; }

double plain_attempt(const Pose& at, const Attempt& attempt) {
  const double over_plane = action::transit_cost(*task(), at, attempt.base_from_start) + attempt.cost;
  const double near = action::near_insertion_cost(*task(), at, attempt.base_from_seated, attempt.axis());
  return weights().action + std::min(over_plane, near);
}

TEST(RatePolicy, OfOnePoseIsTheCheaperWayToASeat) {
  Rng rng(1);
  Setting setting(20, rng);
  RatePolicy policy = setting.policy();
  for (std::size_t member = 0; member < 20; ++member) {
    const Pose at = random_place(rng);
    EXPECT_NEAR(policy.cost({member}, at), plain_attempt(at, setting.attempts[member]), 1e-12);
  }
}

/// To a probe's start on the retreat plane, or near by to where it has three centimetres to go until `touch`: less what
/// is saved of it then.
double plain_way(const Pose& at, const action::Motion& probe, std::size_t touch) {
  const double over_plane = weights().action + action::transit_cost(*task(), at, probe.base_from_start);
  std::size_t near = std::min(touch, probe.cost_to.size() - 1);
  const double end = probe.cost_to[near];
  while (near > 0 && probe.cost_to[near] > end - 0.03 * weights().metre) --near;
  const Pose& there = probe.bodies.base_from_body(near, 0);
  const double by = weights().metre * (0.03 + (there.translation() - at.translation()).norm()) +
                    weights().radian * geometry::angle_between(at, there);
  return std::min(over_plane, weights().action + by - probe.cost_to[near]);
}

/// One after another.
double plain_attempts(const Setting& setting, const Members& members, const Pose& at) {
  double cost = 0.0;
  Pose from = at;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const Attempt& attempt = setting.attempts[members[i]];
    const double still = static_cast<double>(members.size() - i) / static_cast<double>(members.size());
    cost += still * plain_attempt(from, attempt);
    from = attempt.base_from_seated;
  }
  return cost;
}

/// The probe with the most bits per cost, and what it leaves, or attempts if those are cheaper.
double plain_cost(Setting& setting, const Members& members, const Pose& at) {
  constexpr std::size_t few = 12;
  Bitset set(setting.attempts.size());
  for (const std::size_t member : members) set.set(member);
  action::MotionPtr best;
  std::vector<solver::Group> parts;
  double highest = 1e-9;
  const auto cost_to = [](const action::Motion& probe, const solver::Group& group) {
    return probe.cost_to[std::min(group.first, probe.cost_to.size() - 1)];
  };
  const auto share = [&](const solver::Group& group) {
    return static_cast<double>(group.poses.size()) / static_cast<double>(members.size());
  };
  for (const action::MotionPtr& probe : setting.probes) {
    const auto least = setting.predictions.least_told_apart(probe, set, dimensions);
    const std::vector<solver::Group> groups = setting.predictions.split(probe, set, least);
    double bits = 0.0, cost = 0.02;
    for (const solver::Group& group : groups) {
      bits -= share(group) * std::log2(share(group));
      cost += share(group) * cost_to(*probe, group);
    }
    if (bits / cost > highest) highest = bits / cost, best = probe, parts = groups;
  }
  if (!best) return plain_attempts(setting, members, at);
  double probing = plain_way(at, *best, parts.front().first);
  for (const solver::Group& part : parts)
    probing += share(part) *
               (cost_to(*best, part) + plain_cost(setting, part.poses, best->bodies.base_from_body(part.first - 1, 0)));
  return members.size() > few ? probing : std::min(probing, plain_attempts(setting, members, at));
}

TEST(RatePolicy, CostsWhatTheSameCostsPlainly) {
  Rng rng(8);
  Setting setting(28, rng);
  RatePolicy policy = setting.policy();
  int probed = 0;
  for (int i = 0; i < 30; ++i) {
    const Members members = random_members(28, rng);
    const Pose at = random_place(rng);
    const double cost = policy.cost(members, at);
    EXPECT_NEAR(cost, plain_cost(setting, members, at), 1e-9) << members.size() << " poses";
    probed += cost < plain_attempts(setting, members, at) - 1e-9;
  }
  EXPECT_GT(probed, 5);
}

TEST(RatePolicy, NeverCostsLessThanGoingStraightToEachPoseAndOnAverageWhatItCostsByPose) {
  Rng rng(2);
  Setting setting(60, rng);
  RatePolicy policy = setting.policy();
  for (int i = 0; i < 200; ++i) {
    const Members members = random_members(60, rng);
    const Pose at = random_place(rng);
    const std::vector<double> costs = policy.costs(members, at);
    ASSERT_EQ(costs.size(), members.size());
    double sum = 0.0;
    for (std::size_t m = 0; m < members.size(); ++m) {
      sum += costs[m];
      ASSERT_GE(costs[m], setting.straight(at, members[m]) - 1e-9);
    }
    ASSERT_NEAR(sum / static_cast<double>(members.size()), policy.cost(members, at), 1e-9);
  }
}

TEST(RatePolicy, CostsTheSameWheneverAsked) {
  Rng rng(3);
  Setting setting(28, rng);
  RatePolicy used = setting.policy();
  std::vector<std::pair<Members, Pose>> asked;
  std::vector<double> cost;
  for (int i = 0; i < 60; ++i) {
    asked.emplace_back(random_members(28, rng), random_place(rng));
    cost.push_back(used.cost(asked.back().first, asked.back().second));
  }
  RatePolicy backwards = setting.policy();
  for (std::size_t i = asked.size(); i-- > 0;) {
    ASSERT_EQ(backwards.cost(asked[i].first, asked[i].second), cost[i]) << i;
    ASSERT_EQ(used.cost(asked[i].first, asked[i].second), cost[i]) << i;
  }
}

BeliefStatePtr bounded_start(const std::vector<Pose>& poses) {
  return std::make_shared<solver::PoseProblem>(task(), std::make_shared<action::ActionLibrary>(*task()),
                                               std::make_shared<solver::Predictions>(task(), poses), 5.0, 0.035,
                                               SecondValue::upper_bound)
      ->start(task()->scene().start);
}

TEST(UpperBound, IsNeverBelowTheLowerOne) {
  Rng rng(5);
  for (int walk = 0; walk < 12; ++walk) {
    BeliefStatePtr state = bounded_start(random_poses(2 + rng.below(40), rng));
    for (int depth = 0; depth < 4; ++depth) {
      const solver::Values values = state->heuristic();
      ASSERT_GT(values[0], 0.0);
      ASSERT_LE(values[0], values[1]);
      ASSERT_LT(values[1], 10.0);
      const std::vector<solver::Choice> choices = state->choices(support::Deadline::unlimited());
      if (choices.empty()) break;
      const solver::Choice& choice = choices[rng.below(choices.size())];
      const solver::Outcome& outcome = choice.outcomes[rng.below(choice.outcomes.size())];
      if (outcome.goal) break;
      state = state->successor(choice, outcome);
    }
  }
}

TEST(UpperBound, AndTheLowerOneOnlyCloseInOnEachOther) {
  Rng rng(6);
  for (int episode = 0; episode < 6; ++episode) {
    const BeliefStatePtr belief = bounded_start(random_poses(2 + rng.below(14), rng, rng.uniform(0.3, 1.0)));
    const solver::Values first = belief->heuristic();
    Search search(belief, {.bounded = true, .gap = 0.0});
    std::vector<solver::Values> before;
    for (int run = 0; run < 8; ++run) {
      Deadline deadline(std::numeric_limits<double>::infinity(), 4);
      search.run(deadline);
      for (std::size_t node = 0; node < search.size(); ++node) {
        const solver::Values now{search.value(static_cast<int>(node), ValueType::admissible),
                                 search.value(static_cast<int>(node), ValueType::inadmissible)};
        ASSERT_LE(now[0], now[1] + 1e-9) << "node " << node << " of " << search.size();
        if (node < before.size()) {
          ASSERT_GE(now[0], before[node][0]);
          ASSERT_LE(now[1], before[node][1]);
        } else {
          before.emplace_back();
        }
        before[node] = now;
      }
      ASSERT_LE(before[Search::start][1], first[1]);
      ASSERT_GE(before[Search::start][0], first[0]);
    }
  }
}

}  // namespace
}  // namespace tactus::test
