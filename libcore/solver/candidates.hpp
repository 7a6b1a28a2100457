// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "solver/alternatives.hpp"

namespace tactus::solver {

/// The motions weighed at an expanded belief in the order in which they are to be tried: always the best of those that
/// are left, by the solver's rule, as they are weighed by then.
class Candidates {
 public:
  /// `search` must outlive it. `rule`: of a one-step solver; none: by Q. `telling`: only motions that tell so large a
  /// share of the bits per cost that the best one tells, or reach the goal more likely than not (`falling_short`).
  /// `held_back`: those that come when no other is left, which is better than nothing.
  Candidates(const Search& search, int node, std::optional<Greedy> rule, double telling,
             std::vector<std::size_t> held_back);

  /// The choice to try now; none if nothing is left. The same until it is ruled out or the search weighs it anew.
  std::optional<std::size_t> next();

  void rule_out(std::size_t choice, Verdict why);

  /// What became of each, were `chosen` handed out.
  std::vector<Verdict> verdicts(std::size_t chosen) const;

 private:
  std::optional<std::size_t> best() const;
  std::vector<bool> left_out() const;

  const Search& search_;
  int node_;
  std::optional<Greedy> rule_;
  double telling_;
  std::vector<std::size_t> held_back_;
  std::vector<Verdict> verdicts_;  ///< by choice; those that were not passed over are not tried
};

}  // namespace tactus::solver
