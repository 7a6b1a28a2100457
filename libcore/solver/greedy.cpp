// SPDX-License-Identifier: BSD-3-Clause
#include "solver/greedy.hpp"

namespace tactus::solver {
namespace {

constexpr double least_information = 1e-9;  // bits
constexpr double fixed_cost = 0.02;         // m, of the rate rule

double score(const Choice& choice, Greedy rule) {
  switch (rule) {
    case Greedy::tbl:
      return choice.information();
    case Greedy::frontier:
      return -choice.expected_cost();
    case Greedy::rate:
      return choice.information() / (choice.expected_cost() + fixed_cost);
  }
  return 0.0;
}

double goal_probability(const Choice& choice) {
  double sum = 0.0;
  for (const Outcome& outcome : choice.outcomes)
    if (outcome.goal) sum += outcome.probability;
  return sum;
}

}  // namespace

std::optional<std::size_t> greedy_choice(const std::vector<Choice>& choices, Greedy rule,
                                         const std::vector<bool>& banned) {
  std::optional<std::size_t> best;
  double highest = -1e300;
  bool finishes = false;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (i < banned.size() && banned[i]) continue;
    const bool completes = goal_probability(choices[i]) > 0.5;
    if (finishes && !completes) continue;
    if (!completes && choices[i].information() <= least_information) continue;
    const double value = completes ? -choices[i].expected_cost() : score(choices[i], rule);
    if (value > highest || (completes && !finishes)) highest = value, best = i;
    finishes = finishes || completes;
  }
  return best;
}

}  // namespace tactus::solver
