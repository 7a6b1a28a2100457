// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <utility>

#include "solver/problem.hpp"

namespace tactus::solver {

/// The one-step rules that planners are compared with.
enum class Greedy {
  tbl,       ///< touch-based localisation: the most expected information, whatever it costs
  frontier,  ///< the cheapest motion with any information
  rate,      ///< the most expected information per (expected cost + 2 cm)
};

/// What a rule makes of a motion, the highest being best: whether it more likely than not reaches the goal, then the
/// rule's own score, or how cheap it is.
using Merit = std::pair<bool, double>;

/// None if the motion neither carries information nor is likely to reach the goal.
std::optional<Merit> merit_of(const Choice& choice, Greedy rule);

/// The index of the chosen motion; none if none carries information or reaches the goal.
std::optional<std::size_t> greedy_choice(const std::vector<Choice>& choices, Greedy rule,
                                         const std::vector<bool>& banned = {});

}  // namespace tactus::solver
