// SPDX-License-Identifier: BSD-3-Clause
#include "solver/solvers.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "support/error.hpp"

namespace tactus::solver {
namespace {

using support::Error;
using support::Status;

constexpr std::array<std::pair<Solver, const char*>, 7> names{{{Solver::rtdp_bel, "rtdp-bel"},
                                                               {Solver::rtdp_inad, "rtdp-inad"},
                                                               {Solver::rtdp_ad, "rtdp-ad"},
                                                               {Solver::brtdp_bel, "brtdp-bel"},
                                                               {Solver::tbl, "tbl"},
                                                               {Solver::frontier, "frontier"},
                                                               {Solver::rate, "rate"}}};

}  // namespace

std::optional<Solver> solver_from(const std::string& name) {
  for (const auto& [solver, text] : names)
    if (name == text) return solver;
  return std::nullopt;
}

const char* name_of(Solver solver) {
  for (const auto& [candidate, text] : names)
    if (candidate == solver) return text;
  return "unknown";
}

std::optional<Greedy> greedy_of(Solver solver) {
  switch (solver) {
    case Solver::tbl:
      return Greedy::tbl;
    case Solver::frontier:
      return Greedy::frontier;
    case Solver::rate:
      return Greedy::rate;
    default:
      return std::nullopt;
  }
}

SecondValue second_value_of(Solver solver) {
  return solver == Solver::brtdp_bel ? SecondValue::upper_bound : SecondValue::greedy;
}

SearchOptions search_options(const PlannerOptions& options) {
  SearchOptions search{options.epsilon, options.horizon};
  if (options.solver == Solver::rtdp_inad) search.epsilon = 0.0;
  if (options.solver == Solver::rtdp_ad) search.epsilon = 1.0;
  search.bounded = second_value_of(options.solver) == SecondValue::upper_bound;
  return search;
}

void check(const PlannerOptions& options) {
  const auto fail = [](const std::string& what) { throw Error(Status::invalid_argument, "planner options: " + what); };
  if (std::none_of(names.begin(), names.end(), [&](const auto& entry) { return entry.first == options.solver; }))
    fail("solver: found " + std::to_string(static_cast<int>(options.solver)) + ", expected 1 to 7");
  if (!(options.cost_per_bit >= 0.0))
    fail("cost_per_bit: found " + std::to_string(options.cost_per_bit) + ", expected a number that is not negative");
  if (!(options.budget_seconds > 0.0))
    fail("budget_seconds: found " + std::to_string(options.budget_seconds) + ", expected a positive number");
  if (std::isinf(options.budget_seconds) && options.budget_expansions == 0)
    fail("found no budget, expected seconds or expansions");
  if (!(options.epsilon >= 0.0 && options.epsilon <= 1.0))
    fail("epsilon: found " + std::to_string(options.epsilon) + ", expected 0 to 1");
  if (options.horizon < 1) fail("horizon: found " + std::to_string(options.horizon) + ", expected at least 1");
}

}  // namespace tactus::solver
