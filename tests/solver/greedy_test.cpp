// SPDX-License-Identifier: BSD-3-Clause
#include "solver/greedy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "support/rng.hpp"

/// The one-step rules against their definitions, written out.
namespace tactus::solver {
namespace {

using support::Rng;

constexpr std::array rules{Greedy::tbl, Greedy::frontier, Greedy::rate};

/// Mostly of several outcomes; some of one, which says nothing; few of them the goal.
Choice random_choice(Rng& rng, double goals) {
  Choice choice;
  double total = 0.0;
  for (std::uint64_t z = 1 + rng.below(4); z > 0; --z) {
    Outcome outcome;
    outcome.waypoint = choice.outcomes.size() + 1;
    outcome.probability = rng.uniform(0.05, 1.0);
    outcome.cost = rng.uniform(0.01, 0.5);
    outcome.goal = rng.uniform() < goals;
    total += outcome.probability;
    choice.outcomes.push_back(outcome);
  }
  for (Outcome& outcome : choice.outcomes) outcome.probability /= total;
  return choice;
}

std::vector<Choice> random_choices(Rng& rng, double goals) {
  std::vector<Choice> choices;
  for (std::uint64_t i = rng.below(12); i > 0; --i) choices.push_back(random_choice(rng, goals));
  return choices;
}

double bits(const Choice& choice) {
  double sum = 0.0;
  for (const Outcome& outcome : choice.outcomes) sum += outcome.probability * std::log2(1.0 / outcome.probability);
  return sum;
}

double cost(const Choice& choice) {
  double sum = 0.0;
  for (const Outcome& outcome : choice.outcomes) sum += outcome.probability * outcome.cost;
  return sum;
}

bool likely_finishes(const Choice& choice) {
  double goal = 0.0;
  for (const Outcome& outcome : choice.outcomes) goal += outcome.goal ? outcome.probability : 0.0;
  return goal > 0.5;
}

double merit(const Choice& choice, Greedy rule) {
  if (rule == Greedy::tbl) return bits(choice);
  return rule == Greedy::frontier ? -cost(choice) : bits(choice) / (cost(choice) + 0.02);
}

/// The cheapest of those that more likely than not finish; else the one of most merit among those that say something:
/// for frontier, a fifth of what any says.
std::optional<std::size_t> plain_choice(const std::vector<Choice>& choices, Greedy rule,
                                        const std::vector<bool>& banned) {
  std::vector<std::pair<double, std::size_t>> finishing, informing;
  double most = 0.0;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (!banned[i]) most = std::max(most, bits(choices[i]));
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (banned[i]) continue;
    if (likely_finishes(choices[i])) finishing.emplace_back(-cost(choices[i]), i);
    const bool is_too_little = rule == Greedy::frontier && bits(choices[i]) <= 0.2 * most;
    if (choices[i].outcomes.size() > 1 && !is_too_little) informing.emplace_back(merit(choices[i], rule), i);
  }
  const auto& candidates = finishing.empty() ? informing : finishing;
  if (candidates.empty()) return std::nullopt;
  return std::max_element(candidates.begin(), candidates.end())->second;
}

TEST(Choice, SumsArePlainSums) {
  Rng rng(1);
  for (int i = 0; i < 200; ++i) {
    const Choice choice = random_choice(rng, 0.1);
    EXPECT_NEAR(choice.expected_cost(), cost(choice), 1e-12);
    EXPECT_NEAR(choice.information(), bits(choice), 1e-12);
  }
}

TEST(Greedy, PicksWhatItsRuleSays) {
  Rng rng(2);
  int found = 0, none = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<Choice> choices = random_choices(rng, i % 2 == 0 ? 0.0 : 0.15);
    std::vector<bool> banned(choices.size(), false);
    for (std::size_t k = 0; k < choices.size(); ++k) banned[k] = i % 4 < 2 && rng.below(2) == 0;
    for (const Greedy rule : rules) {
      const auto expected = plain_choice(choices, rule, banned);
      EXPECT_EQ(greedy_choice(choices, rule, banned), expected);
      (expected ? found : none) += 1;
    }
  }
  EXPECT_GT(found, 1000);
  EXPECT_GT(none, 100);
}

TEST(Greedy, LeavesOutWhatIsBannedUntilNothingIsLeft) {
  Rng rng(3);
  const std::vector<Choice> choices = random_choices(rng, 0.1);
  for (const Greedy rule : rules) {
    std::vector<bool> banned(choices.size(), false);
    for (auto choice = greedy_choice(choices, rule, banned); choice; choice = greedy_choice(choices, rule, banned)) {
      ASSERT_FALSE(banned[*choice]);
      banned[*choice] = true;
    }
    for (std::size_t i = 0; i < choices.size(); ++i)
      EXPECT_EQ(banned[i], choices[i].outcomes.size() > 1 || choices[i].outcomes[0].goal);
  }
}

TEST(FallingShort, IsWhatTellsTooLittleForItsCostBesideTheBestThatMayBeChosen) {
  Rng rng(4);
  int short_ones = 0, others = 0;
  for (int i = 0; i < 2000; ++i) {
    const std::vector<Choice> choices = random_choices(rng, 0.15);
    std::vector<bool> banned(choices.size(), false);
    for (std::size_t k = 0; k < choices.size(); ++k) banned[k] = i % 2 == 0 && rng.below(2) == 0;
    const double share = rng.uniform(0.0, 1.0);
    const std::vector<bool> falls_short = falling_short(choices, share, banned);
    for (std::size_t a = 0; a < choices.size(); ++a) {
      const bool is_beaten = [&] {
        for (std::size_t b = 0; b < choices.size(); ++b)
          if (!banned[b] && merit(choices[a], Greedy::rate) < share * merit(choices[b], Greedy::rate)) return true;
        return false;
      }();
      ASSERT_EQ(falls_short[a], banned[a] || (is_beaten && choices[a].goal_probability() <= 0.5));
      (falls_short[a] ? short_ones : others) += 1;
    }
  }
  EXPECT_GT(short_ones, 1000);
  EXPECT_GT(others, 1000);
}

TEST(FallingShort, LeavesTheBestAsLongAsAnyMayBeChosen) {
  Rng rng(5);
  for (int i = 0; i < 200; ++i) {
    const std::vector<Choice> choices = random_choices(rng, 0.15);
    const auto best = greedy_choice(choices, Greedy::rate);
    if (!best) continue;
    EXPECT_FALSE(falling_short(choices, 1.0)[*best]);
  }
}

TEST(GreedyCostPerBit, PaysForTheMotionWithTheBestRate) {
  EXPECT_DOUBLE_EQ(greedy_cost_per_bit({0.3, 0.1, 0.2}, {3.0, 0.5, 0.0}, 0.035), 0.15);
  EXPECT_DOUBLE_EQ(greedy_cost_per_bit({0.3}, {30.0}, 0.035), 0.035) << "not less than the least";
  EXPECT_DOUBLE_EQ(greedy_cost_per_bit({0.3}, {0.0}, 0.035), 0.035) << "nothing informs";
  EXPECT_DOUBLE_EQ(greedy_cost_per_bit({}, {}, 0.035), 0.035);
}

}  // namespace
}  // namespace tactus::solver
