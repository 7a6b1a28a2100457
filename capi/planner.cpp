// SPDX-License-Identifier: BSD-3-Clause
#include "tactus/planner.h"

#include <limits>

#include "handles.hpp"

using namespace tactus;
using namespace tactus::capi;

namespace {

using solver::Solver;
using solver::Verdict;

static_assert(TACTUS_SOLVER_RTDP_BEL == static_cast<int>(Solver::rtdp_bel) &&
              TACTUS_SOLVER_RTDP_INAD == static_cast<int>(Solver::rtdp_inad) &&
              TACTUS_SOLVER_RTDP_AD == static_cast<int>(Solver::rtdp_ad) &&
              TACTUS_SOLVER_BRTDP_BEL == static_cast<int>(Solver::brtdp_bel) &&
              TACTUS_SOLVER_TBL == static_cast<int>(Solver::tbl) &&
              TACTUS_SOLVER_FRONTIER == static_cast<int>(Solver::frontier) &&
              TACTUS_SOLVER_RATE == static_cast<int>(Solver::rate));

bool is_solver(tactus_solver solver) { return solver >= TACTUS_SOLVER_RTDP_BEL && solver <= TACTUS_SOLVER_RATE; }

tactus_planner_options options_of(const solver::PlannerOptions& from) {
  tactus_planner_options options{};
  options.solver = static_cast<tactus_solver>(from.solver);
  options.budget_seconds = from.budget_seconds;
  options.budget_expansions = from.budget_expansions;
  options.epsilon = from.epsilon;
  options.horizon = from.horizon;
  options.seed = from.seed;
  return options;
}

/// `defaults` with all that the caller may say replaced.
solver::PlannerOptions options_from(const tactus_planner_options& given, solver::PlannerOptions defaults) {
  if (!is_solver(given.solver)) reject("options.solver", std::to_string(given.solver), "one of TACTUS_SOLVER_*");
  constexpr int farthest = std::numeric_limits<int>::max();
  if (given.horizon < 1 || given.horizon > farthest)
    reject("options.horizon", std::to_string(given.horizon), "1 to " + std::to_string(farthest));
  defaults.solver = static_cast<Solver>(given.solver);
  defaults.budget_seconds = given.budget_seconds;
  defaults.budget_expansions = given.budget_expansions;
  defaults.epsilon = given.epsilon;
  defaults.horizon = static_cast<int>(given.horizon);
  defaults.seed = given.seed;
  return defaults;
}

tactus_statistics statistics_of(const solver::PlannerStatistics& from) {
  tactus_statistics statistics{};
  statistics.from_policy = from.from_policy ? 1 : 0;
  statistics.expansions = from.expansions;
  statistics.seconds = from.seconds;
  statistics.lower_bound = from.lower_bound;
  statistics.value = from.value;
  statistics.total_calls = from.total_calls;
  statistics.total_expansions = from.total_expansions;
  statistics.total_seconds = from.total_seconds;
  return statistics;
}

static_assert(TACTUS_VERDICT_PASSED_OVER == static_cast<int>(Verdict::passed_over) &&
              TACTUS_VERDICT_CHOSEN == static_cast<int>(Verdict::chosen) &&
              TACTUS_VERDICT_UNREACHABLE == static_cast<int>(Verdict::unreachable) &&
              TACTUS_VERDICT_SET_ASIDE == static_cast<int>(Verdict::set_aside));

/// Of the tool link.
geometry::Vector3 position_at(const action::Motion& motion, std::size_t waypoint) {
  return motion.bodies.base_from_body(waypoint, 0).translation();
}

tactus_alternative alternative_of(const solver::Alternative& from) {
  const action::Motion& motion = *from.choice.motion;
  const geometry::Vector3 start = motion.base_from_start.translation();
  const geometry::Vector3 end = position_at(motion, motion.path.size() - 1);
  tactus_alternative alternative{};
  alternative.kind = static_cast<tactus_action_kind>(motion.kind);
  alternative.verdict = static_cast<tactus_verdict>(from.verdict);
  alternative.outcomes = static_cast<uint32_t>(from.choice.outcomes.size());
  alternative.lower_bound = from.q[0];
  alternative.value = from.q[1];
  alternative.motion_cost = from.choice.expected_cost();
  alternative.information = from.choice.information();
  alternative.contact_probability = from.choice.contact_probability();
  alternative.goal_probability = from.choice.goal_probability();
  std::copy(start.begin(), start.end(), alternative.start);
  std::copy(end.begin(), end.end(), alternative.end);
  return alternative;
}

const solver::Alternative& alternative_at(const tactus_planner& planner, size_t index) {
  const std::vector<solver::Alternative>& alternatives = planner.planner.alternatives();
  return alternatives[index_below(alternatives.size(), index, "index")];
}

Status status_of(solver::Answer::Kind kind) {
  switch (kind) {
    case solver::Answer::Kind::action:
      return Status::ok;
    case solver::Answer::Kind::goal_reached:
      return Status::goal_reached;
    case solver::Answer::Kind::no_informative_action:
      return Status::no_informative_action;
    case solver::Answer::Kind::cancelled:
      return Status::cancelled;
  }
  return Status::internal;
}

}  // namespace

solver::PlannerOptions tactus::capi::planner_options(const tactus_planner_options* options,
                                                     const solver::PlannerOptions& defaults) {
  return options == nullptr ? defaults : options_from(read_struct(options, options_of(defaults), "options"), defaults);
}

const char* tactus_solver_name(tactus_solver solver) noexcept {
  return is_solver(solver) ? solver::name_of(static_cast<Solver>(solver)) : "unknown";
}

tactus_status tactus_solver_from_name(const char* name, tactus_solver* solver) noexcept {
  return guarded(__func__, [&] {
    const auto found = solver::solver_from(&required(name, "name"));
    if (!found)
      reject("name", "'" + std::string(name) + "'", "rtdp-bel, rtdp-inad, rtdp-ad, brtdp-bel, tbl, frontier or rate");
    required(solver, "solver") = static_cast<tactus_solver>(*found);
  });
}

tactus_status tactus_planner_options_init(tactus_planner_options* options, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(options, size, options_of({}), "options"); });
}

tactus_status tactus_scenario_planner_options(const tactus_scenario* scenario,
                                              tactus_planner_options* options) noexcept {
  return guarded(__func__, [&] {
    write_struct(options, options_of(required(scenario, "scenario").contents->planner), "options");
  });
}

tactus_status tactus_planner_create(const tactus_scenario* scenario, const tactus_planner_options* options,
                                    tactus_planner** planner) noexcept {
  return guarded(__func__, [&] {
    tactus_planner*& made = cleared(planner, "planner");
    const ScenarioPtr& contents = required(scenario, "scenario").contents;
    made = new tactus_planner(contents, planner_options(options, contents->planner));
  });
}

void tactus_planner_destroy(tactus_planner* planner) noexcept { delete planner; }

tactus_status tactus_planner_query_action(tactus_planner* planner, const tactus_belief* belief,
                                          tactus_action** action) noexcept {
  return guarded(__func__, [&] {
    tactus_action*& found = cleared(action, "action");
    const Use planner_use(required(planner, "planner").in_use, "planner");
    const Use belief_use(required(belief, "belief").in_use, "belief");
    check_same(planner->scenario, belief->scenario, "belief");
    const solver::Answer answer = planner->planner.query(belief->belief);
    if (answer.kind == solver::Answer::Kind::action) found = new tactus_action{planner->scenario, answer.action};
    return status_of(answer.kind);
  });
}

tactus_status tactus_planner_cancel(tactus_planner* planner) noexcept {
  return guarded(__func__, [&] { required(planner, "planner").planner.cancel(); });
}

tactus_status tactus_statistics_init(tactus_statistics* statistics, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(statistics, size, tactus_statistics{}, "statistics"); });
}

tactus_status tactus_planner_statistics(const tactus_planner* planner, tactus_statistics* statistics) noexcept {
  return guarded(__func__, [&] {
    const Use use(required(planner, "planner").in_use, "planner");
    write_struct(statistics, statistics_of(planner->planner.statistics()), "statistics");
  });
}

const char* tactus_verdict_name(tactus_verdict verdict) noexcept {
  switch (verdict) {
    case TACTUS_VERDICT_PASSED_OVER:
      return "passed over";
    case TACTUS_VERDICT_CHOSEN:
      return "chosen";
    case TACTUS_VERDICT_UNREACHABLE:
      return "unreachable";
    case TACTUS_VERDICT_SET_ASIDE:
      return "set aside";
    default:
      return "unknown";
  }
}

tactus_status tactus_alternative_init(tactus_alternative* alternative, size_t size) noexcept {
  return guarded(__func__, [&] { init_struct(alternative, size, tactus_alternative{}, "alternative"); });
}

tactus_status tactus_planner_alternative_count(const tactus_planner* planner, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Use use(required(planner, "planner").in_use, "planner");
    required(count, "count") = planner->planner.alternatives().size();
  });
}

tactus_status tactus_planner_alternative(const tactus_planner* planner, size_t index,
                                         tactus_alternative* alternative) noexcept {
  return guarded(__func__, [&] {
    const Use use(required(planner, "planner").in_use, "planner");
    write_struct(alternative, alternative_of(alternative_at(*planner, index)), "alternative");
  });
}

tactus_status tactus_planner_alternative_outcomes(const tactus_planner* planner, size_t index, double* outcomes,
                                                  size_t capacity, size_t* count) noexcept {
  return guarded(__func__, [&] {
    const Use use(required(planner, "planner").in_use, "planner");
    const solver::Choice& choice = alternative_at(*planner, index).choice;
    double* out = room_for(choice.outcomes.size(), outcomes, capacity, count, "outcomes");
    if (out == nullptr) return;
    for (const solver::Outcome& outcome : choice.outcomes) {
      const geometry::Vector3 stands = position_at(*choice.motion, outcome.waypoint - 1);
      *out++ = outcome.probability;
      *out++ = outcome.cost;
      *out++ = outcome.waypoint < choice.motion->path.size() ? 1.0 : 0.0;
      *out++ = outcome.goal ? 1.0 : 0.0;
      out = std::copy(stands.begin(), stands.end(), out);
    }
  });
}
