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
  TACTUS_SOLVER_BRTDP_BEL = 4, /**< bounds of poses, with walks that look for the target: the default */
  TACTUS_SOLVER_TBL = 5,
  TACTUS_SOLVER_FRONTIER = 6,
  TACTUS_SOLVER_RATE = 7 /**< greedy: information gain per cost */
};

/** "rtdp-bel" and so on, as in scenario files; "unknown" for any other number. A constant. Any thread. */
TACTUS_API const char* tactus_solver_name(tactus_solver solver) TACTUS_NOEXCEPT;

/** The solver of that name. TACTUS_INVALID_ARGUMENT if there is none. Any thread. */
TACTUS_API tactus_status tactus_solver_from_name(const char* name, tactus_solver* solver) TACTUS_NOEXCEPT;

/**
 * A query ends when either budget is spent and the belief itself is weighed. With one in expansions only, the same
 * scenario and seed give the same actions on every machine; one in seconds cannot promise that.
 */
typedef struct tactus_planner_options {
  uint32_t struct_size;
  tactus_solver solver;
  double budget_seconds;      /**< for a query; INFINITY: none. > 0 */
  uint64_t budget_expansions; /**< for a query; 0: none */
  double epsilon;             /**< share of the budget in which the admissible values lead (rtdp-bel); in [0, 1] */
  int64_t horizon;            /**< actions looked ahead; 1 to 2147483647 */
  uint64_t seed;              /**< of all that is random */
} tactus_planner_options;

/** Sets `struct_size` to `size`, which is `sizeof *options`, and the rest to the library's defaults. */
TACTUS_API tactus_status tactus_planner_options_init(tactus_planner_options* options, size_t size) TACTUS_NOEXCEPT;

/** The scenario's own options. TACTUS_STRUCT_SIZE. */
TACTUS_API tactus_status tactus_scenario_planner_options(const tactus_scenario* scenario,
                                                         tactus_planner_options* options) TACTUS_NOEXCEPT;

/**
 * A planner for beliefs of this scenario, of either kind. `options`: NULL for the scenario's. With brtdp-bel it takes
 * half a second: motions for the first query are made here; with a budget in seconds one to two, as that query is
 * rehearsed.
 *
 * TACTUS_INVALID_ARGUMENT (out of range, NaN), TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_planner_create(const tactus_scenario* scenario, const tactus_planner_options* options,
                                               tactus_planner** planner) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_planner_destroy(tactus_planner* planner) TACTUS_NOEXCEPT;

/**
 * What to do next. Takes up to the budget, or next to nothing when it follows the policy. The belief itself is always
 * weighed whole: where a second is too short for that it was seen to take up to 2.4.
 *
 * TACTUS_GOAL_REACHED, TACTUS_NO_INFORMATIVE_ACTION and TACTUS_CANCELLED come with a NULL action and are not errors.
 * TACTUS_WRONG_SCENARIO; TACTUS_BUSY if another thread uses the planner or the belief.
 */
TACTUS_API tactus_status tactus_planner_query_action(tactus_planner* planner, const tactus_belief* belief,
                                                     tactus_action** action) TACTUS_NOEXCEPT;

/**
 * The query that is running returns TACTUS_CANCELLED within some milliseconds, unless it has its answer. Without one,
 * nothing happens. Any thread.
 */
TACTUS_API tactus_status tactus_planner_cancel(tactus_planner* planner) TACTUS_NOEXCEPT;

/**
 * What the last query took, and (total) all of them since the planner was created. `lower_bound` and `value` are of the
 * belief for which the last action was handed out, 0 before: a query that hands out none leaves them as they are.
 */
typedef struct tactus_statistics {
  uint32_t struct_size;
  int32_t from_policy;  /**< 1: the action was computed by an earlier query */
  uint64_t expansions;  /**< 0 if it did not plan */
  double seconds;       /**< 0 if it did not plan */
  double lower_bound;   /**< admissible value of that belief, in units of cost */
  double value;         /**< inadmissible value of that belief, in units of cost */
  uint64_t total_calls; /**< queries that planned */
  uint64_t total_expansions;
  double total_seconds;
} tactus_statistics;

/** Sets `struct_size` to `size`, which is `sizeof *statistics`, and everything else to 0. */
TACTUS_API tactus_status tactus_statistics_init(tactus_statistics* statistics, size_t size) TACTUS_NOEXCEPT;

/** TACTUS_STRUCT_SIZE, TACTUS_BUSY. */
TACTUS_API tactus_status tactus_planner_statistics(const tactus_planner* planner,
                                                   tactus_statistics* statistics) TACTUS_NOEXCEPT;

/* --- why this action */

typedef int32_t tactus_verdict;

enum {
  TACTUS_VERDICT_PASSED_OVER = 0, /**< a better one was found */
  TACTUS_VERDICT_CHOSEN = 1,      /**< handed out */
  TACTUS_VERDICT_UNREACHABLE = 2, /**< no free way to its start was found */
  TACTUS_VERDICT_SET_ASIDE = 3    /**< it changed nothing when last tried, others come first while the belief stalls,
                                       or it tells too little for its cost beside another */
};

/** "passed over", "chosen", "unreachable", "set aside"; "unknown" for any other number. A constant. Any thread. */
TACTUS_API const char* tactus_verdict_name(tactus_verdict verdict) TACTUS_NOEXCEPT;

/**
 * A motion that the planner weighed. Costs are in units of cost, positions are of the tool link in the robot's base
 * frame. What a motion is expected to bring is as the belief was: on voxels its goal is the hand-over to poses.
 */
typedef struct tactus_alternative {
  uint32_t struct_size;
  tactus_action_kind kind;
  tactus_verdict verdict;
  uint32_t outcomes;          /**< number of them */
  double lower_bound;         /**< admissible value of the motion and all that follows */
  double value;               /**< inadmissible value of the same; brtdp-bel on poses: upper bound */
  double motion_cost;         /**< expected, of this motion alone: the way to its start, and as far as it goes */
  double information;         /**< expected bits by which its outcomes split the belief */
  double contact_probability; /**< that it touches the target */
  double goal_probability;    /**< that it reaches the goal */
  double start[3];            /**< m, where the motion proper sets out from */
  double end[3];              /**< m, where it ends if nothing is touched */
} tactus_alternative;

/** Sets `struct_size` to `size`, which is `sizeof *alternative`, and everything else to 0. */
TACTUS_API tactus_status tactus_alternative_init(tactus_alternative* alternative, size_t size) TACTUS_NOEXCEPT;

/**
 * How many motions the planner weighed for the action that the last query handed out, that one among them; 0 if it
 * handed out none. One-step rules weigh only what tells something or reaches the goal. Nothing is kept for this before
 * it is asked for, and asking changes no later answer. The first call after a query takes about a microsecond a motion.
 *
 * TACTUS_BUSY.
 */
TACTUS_API tactus_status tactus_planner_alternative_count(const tactus_planner* planner, size_t* count) TACTUS_NOEXCEPT;

/**
 * One of them. They come in the order in which the solver would have handed them out: those that search by `value`
 * (rtdp-ad by `lower_bound`), the lowest first; one-step rules by their score. The chosen one is the first that is
 * neither unreachable nor set aside; what comes after it was not tried.
 *
 * TACTUS_INVALID_ARGUMENT (no such index), TACTUS_STRUCT_SIZE, TACTUS_BUSY.
 */
TACTUS_API tactus_status tactus_planner_alternative(const tactus_planner* planner, size_t index,
                                                    tactus_alternative* alternative) TACTUS_NOEXCEPT;

/**
 * What may come of one of them, in the order along its path. `outcomes`: double (count x 7), of each its probability
 * (they sum to one), what the motion costs then, 1 if it is a contact, 1 if it reaches the goal, and the x y z (m) of
 * the tool link where the robot then stands.
 *
 * TACTUS_INVALID_ARGUMENT (no such index), TACTUS_BUFFER_TOO_SMALL, TACTUS_BUSY.
 */
TACTUS_API tactus_status tactus_planner_alternative_outcomes(const tactus_planner* planner, size_t index,
                                                             double* outcomes, size_t capacity,
                                                             size_t* count) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
