// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/walks.hpp"

/// What a walk is worth, step by step.
namespace tactus::test {

struct WalkCost {
  double expected = 0.0;   ///< on average until it touches the target, or to its end
  std::size_t missed = 0;  ///< poses that it does not touch
};

inline WalkCost cost_of(const solver::Walk& walk, const solver::Walks& walks, support::Bitset members) {
  const auto total = static_cast<double>(members.count());
  WalkCost cost{walk.entry, 0};
  for (const auto& [place, direction] : walk.steps) {
    const solver::Walks::Step& step = walks.step(place, direction);
    const std::size_t before = members.count();
    members.and_not(step.touched);
    cost.expected += step.cost * 0.5 * static_cast<double>(before + members.count()) / total;
  }
  cost.missed = members.count();
  return cost;
}

}  // namespace tactus::test
