// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "solver/problem.hpp"

namespace tactus::solver {

/// The one-step rules that planners are compared with.
enum class Greedy {
  tbl,       ///< touch-based localisation: the most expected information, whatever it costs
  frontier,  ///< the cheapest motion with at least `frontier_share` of the information of the one with the most
  rate,      ///< the most expected information per (expected cost + 2 cm)
};

/// With any information at all, however little, a sample of poses has `frontier` turn on the spot for what only the
/// sample tells.
inline constexpr double frontier_share = 0.2;

/// The most expected information of some motions (bits).
double most_information(const std::vector<Choice>& choices, const std::vector<bool>& banned = {});

/// What a rule makes of a motion, the highest being best: whether it more likely than not reaches the goal, then the
/// rule's own score, or how cheap it is.
using Merit = std::pair<bool, double>;

/// None if the motion is not likely to reach the goal and carries no information, or too little beside the `most` that
/// any does.
std::optional<Merit> merit_of(const Choice& choice, Greedy rule, double most);

/// By choice, whether it tells less than a `share` of the bits per (expected cost + 2 cm) that the best of those not
/// `banned` tells, and is not likely to reach the goal. What is banned falls short.
std::vector<bool> falling_short(const std::vector<Choice>& choices, double share, const std::vector<bool>& banned = {});

/// The index of the chosen motion; none if none carries information or reaches the goal.
std::optional<std::size_t> greedy_choice(const std::vector<Choice>& choices, Greedy rule,
                                         const std::vector<bool>& banned = {});

}  // namespace tactus::solver
