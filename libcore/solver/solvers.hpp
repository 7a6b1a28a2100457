// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "solver/greedy.hpp"
#include "solver/search.hpp"

namespace tactus::solver {

enum class Solver : std::int32_t {
  rtdp_bel = 1,
  rtdp_inad = 2,
  rtdp_ad = 3,
  brtdp_bel = 4,
  tbl = 5,
  frontier = 6,
  rate = 7
};

/// "rtdp-bel" and so on, as in scenarios and on the command line; none if there is no such solver.
std::optional<Solver> solver_from(const std::string& name);
const char* name_of(Solver solver);

struct PlannerOptions {
  Solver solver = Solver::brtdp_bel;
  double budget_seconds = 1.0;          ///< a planning call; infinity: none
  std::uint64_t budget_expansions = 0;  ///< a planning call; 0: none
  double epsilon = 0.5;                 ///< share of the budget for the admissible values (rtdp-bel, brtdp-bel)
  int horizon = 8;
  std::uint64_t seed = 1;
  double cost_per_bit = 0.035;  ///< of the greedy heuristic on poses, in units of cost
};

/// Throws `invalid_argument`, with the option's name, for what is out of range.
void check(const PlannerOptions& options);

/// The one-step rule that a solver is; none for those that search.
std::optional<Greedy> greedy_of(Solver solver);

/// How a solver searches beliefs whose second value is what `second_value_of` says.
SearchOptions search_options(const PlannerOptions& options);
SecondValue second_value_of(Solver solver);

}  // namespace tactus::solver
