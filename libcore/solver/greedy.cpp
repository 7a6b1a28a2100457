// SPDX-License-Identifier: BSD-3-Clause
#include "solver/greedy.hpp"

#include <algorithm>

namespace tactus::solver {
namespace {

constexpr double least_information = 1e-9;  // bits
constexpr double fixed_cost = 0.02;         // m, of the rate rule
constexpr double likely = 0.5;              // probability of reaching the goal

double least(Greedy rule, double most) {
  return rule == Greedy::frontier ? std::max(least_information, frontier_share * most) : least_information;
}

bool is_banned(const std::vector<bool>& banned, std::size_t choice) { return choice < banned.size() && banned[choice]; }

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

}  // namespace

double most_information(const std::vector<Choice>& choices, const std::vector<bool>& banned) {
  double most = 0.0;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (!is_banned(banned, i)) most = std::max(most, choices[i].information());
  return most;
}

std::optional<Merit> merit_of(const Choice& choice, Greedy rule, double most) {
  if (choice.goal_probability() > likely) return Merit{true, -choice.expected_cost()};
  if (choice.information() <= least(rule, most)) return std::nullopt;
  return Merit{false, score(choice, rule)};
}

std::vector<bool> falling_short(const std::vector<Choice>& choices, double share, const std::vector<bool>& banned) {
  double best = 0.0;
  for (std::size_t i = 0; i < choices.size(); ++i)
    if (!is_banned(banned, i)) best = std::max(best, score(choices[i], Greedy::rate));
  std::vector<bool> falls_short;
  for (std::size_t i = 0; i < choices.size(); ++i)
    falls_short.push_back(is_banned(banned, i) ||
                          (choices[i].goal_probability() <= likely && score(choices[i], Greedy::rate) < share * best));
  return falls_short;
}

std::optional<std::size_t> greedy_choice(const std::vector<Choice>& choices, Greedy rule,
                                         const std::vector<bool>& banned) {
  const double most = most_information(choices, banned);
  std::optional<std::size_t> best;
  std::optional<Merit> highest;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    if (is_banned(banned, i)) continue;
    const auto merit = merit_of(choices[i], rule, most);
    if (merit > highest) highest = merit, best = i;  // none is less than any
  }
  return best;
}

}  // namespace tactus::solver
