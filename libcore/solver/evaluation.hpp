// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/instance.hpp"
#include "solver/solvers.hpp"

namespace tactus::solver {

/// What a solver's policy costs on an instance, exactly: it is run with the target at each of the poses.
struct Evaluation {
  double expected_cost = 0.0;  ///< discounted as the instance says
  double worst_cost = 0.0;     ///< the same, of the pose that costs most
  double inserted = 0.0;     ///< share of the poses, by weight; where it is not 1 the costs are those until it gave up
  double lower_bound = 0.0;  ///< admissible value at the start, undiscounted
  double value = 0.0;        ///< inadmissible value at the start, undiscounted
  std::uint64_t plans = 0;   ///< one for each belief that was met
  std::uint64_t expansions = 0;
};

/// Plans anew at every belief, undiscounted and each time with the whole budget. Throws `invalid_argument` for options
/// out of range or a solver that is not there.
Evaluation evaluate(const InstancePtr& instance, const PlannerOptions& options);

}  // namespace tactus::solver
