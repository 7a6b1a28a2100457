/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_PLANNER_H
#define TACTUS_PLANNER_H

/**
 * A planner: given a belief, the next action, within a budget. It remembers the policy it computed and follows it while
 * the observations are the predicted ones. One thread at a time (TACTUS_BUSY); `tactus_planner_cancel` from any.
 */

#include "tactus/action.h"
#include "tactus/belief.h"
#include "tactus/scenario.h"
#include "tactus/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_planner tactus_planner;

typedef int32_t tactus_solver;

enum {
  TACTUS_SOLVER_RTDP_BEL = 1,  /**< admissible values first, then inadmissible ones: the paper's */
  TACTUS_SOLVER_RTDP_INAD = 2, /**< inadmissible values only */
  TACTUS_SOLVER_RTDP_AD = 3,   /**< admissible values only */
  TACTUS_SOLVER_BRTDP_BEL = 4,
  TACTUS_SOLVER_TBL = 5,
  TACTUS_SOLVER_FRONTIER = 6,
  TACTUS_SOLVER_RATE = 7 /**< greedy: information gain per cost */
};

/** "rtdp-bel" and so on, as in scenario files; "unknown" for any other number. A constant. Any thread. */
TACTUS_API const char* tactus_solver_name(tactus_solver solver) TACTUS_NOEXCEPT;

/** The solver of that name. TACTUS_INVALID_ARGUMENT if there is none. Any thread. */
TACTUS_API tactus_status tactus_solver_from_name(const char* name, tactus_solver* solver) TACTUS_NOEXCEPT;

/**
 * A query ends when either budget is spent. With one in expansions only, the same scenario and seed give the same
 * actions on every machine; one in seconds cannot promise that.
 */
typedef struct tactus_planner_options {
  uint32_t struct_size;
  tactus_solver solver;
  double budget_seconds;      /**< for a query; INFINITY: none. > 0 */
  uint64_t budget_expansions; /**< for a query; 0: none */
  double epsilon;             /**< share of the budget in which the admissible values lead (rtdp-bel); in [0, 1] */
  int64_t horizon;            /**< actions looked ahead; > 0 */
  uint64_t seed;              /**< of all that is random */
} tactus_planner_options;

/** Sets `struct_size` to `size`, which is `sizeof *options`, and the rest to the library's defaults. */
TACTUS_API tactus_status tactus_planner_options_init(tactus_planner_options* options, size_t size) TACTUS_NOEXCEPT;

/** The scenario's own options. TACTUS_STRUCT_SIZE. */
TACTUS_API tactus_status tactus_scenario_planner_options(const tactus_scenario* scenario,
                                                         tactus_planner_options* options) TACTUS_NOEXCEPT;

/**
 * A planner for beliefs of this scenario, of either kind. `options`: NULL for the scenario's.
 *
 * TACTUS_INVALID_ARGUMENT (out of range, NaN), TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_planner_create(const tactus_scenario* scenario, const tactus_planner_options* options,
                                               tactus_planner** planner) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_planner_destroy(tactus_planner* planner) TACTUS_NOEXCEPT;

/**
 * What to do next. Takes up to the budget, or next to nothing when it follows the policy.
 *
 * TACTUS_GOAL_REACHED, TACTUS_NO_INFORMATIVE_ACTION and TACTUS_CANCELLED come with a NULL action and are not errors.
 * TACTUS_WRONG_SCENARIO; TACTUS_BUSY if another thread uses the planner or the belief.
 */
TACTUS_API tactus_status tactus_planner_query_action(tactus_planner* planner, const tactus_belief* belief,
                                                     tactus_action** action) TACTUS_NOEXCEPT;

/** The query that is running returns soon with what it has. Without one, nothing happens. Any thread. */
TACTUS_API tactus_status tactus_planner_cancel(tactus_planner* planner) TACTUS_NOEXCEPT;

/** What the last query took, and (total) all of them since the planner was created. */
typedef struct tactus_statistics {
  uint32_t struct_size;
  int32_t from_policy;  /**< 1: the action was computed by an earlier query */
  uint64_t expansions;  /**< of the last query that planned */
  double seconds;       /**< of the last query */
  double lower_bound;   /**< admissible value at the belief, in units of cost */
  double value;         /**< inadmissible value at the belief, in units of cost */
  uint64_t total_calls; /**< queries that planned */
  uint64_t total_expansions;
  double total_seconds;
} tactus_statistics;

/** Sets `struct_size` to `size`, which is `sizeof *statistics`, and everything else to 0. */
TACTUS_API tactus_status tactus_statistics_init(tactus_statistics* statistics, size_t size) TACTUS_NOEXCEPT;

/** TACTUS_STRUCT_SIZE, TACTUS_BUSY. */
TACTUS_API tactus_status tactus_planner_statistics(const tactus_planner* planner,
                                                   tactus_statistics* statistics) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
