// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "solver/problem.hpp"

namespace tactus::solver {

/// The one-step rules that planners are compared with.
enum class Greedy {
  tbl,       ///< touch-based localisation: the most expected information, whatever it costs
  frontier,  ///< the cheapest motion with any information
  rate,      ///< the most expected information per (expected cost + 2 cm)
};

/// The index of the chosen motion; none if none carries information or reaches the goal.
std::optional<std::size_t> greedy_choice(const std::vector<Choice>& choices, Greedy rule,
                                         const std::vector<bool>& banned = {});

}  // namespace tactus::solver
