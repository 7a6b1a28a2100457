/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_INSTANCE_H
#define TACTUS_INSTANCE_H

/**
 * An instance: a small finite search cut out of a scenario, on which a policy can be compared with the best there is. A
 * few poses, one of which is the target's; a few configurations of the robot; a few motions, and for each what it costs
 * and where it ends. Given the pose nothing is random; what is observed is the configuration the robot gets to, whether
 * a contact brought it there, and whether the tool is seated, which ends the search. Constant: any thread.
 */

#include "tactus/planner.h"
#include "tactus/scenario.h"
#include "tactus/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_instance tactus_instance;

typedef struct tactus_instance_options {
  uint32_t struct_size;
  uint32_t poses;          /**< drawn from the prior, of equal weight; 1 to 1000 */
  uint32_t configurations; /**< at most; 5 to 1000 */
  uint32_t motions; /**< sweeps and pokes, at most, 1 to 1000; beside them an insertion attempt at each pose, and small
                         moves from where sweeps and pokes end */
  double discount;  /**< of the cost of each further motion, in (0, 1]; public solvers need less than 1 */
  uint64_t seed;    /**< of the draw */
} tactus_instance_options;

/** Sets `struct_size` to `size`, which is `sizeof *options`, and the rest to the library's defaults. */
TACTUS_API tactus_status tactus_instance_options_init(tactus_instance_options* options, size_t size) TACTUS_NOEXCEPT;

/**
 * Draws the poses, chooses the motions and works out what comes of them; the same for the same options. After a contact
 * the robot backs off to the nearest of a few waypoints of the motion, after an insertion that failed to a fixed
 * configuration; the ways count. `options`: NULL for the defaults. Takes seconds.
 *
 * TACTUS_INVALID_ARGUMENT (out of range, NaN), TACTUS_MOTION_INFEASIBLE (hardly any pose at which the tool can be
 * inserted), TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_instance_create(const tactus_scenario* scenario, const tactus_instance_options* options,
                                                tactus_instance** instance) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_instance_destroy(tactus_instance* instance) TACTUS_NOEXCEPT;

/** How many there are of each. */
TACTUS_API tactus_status tactus_instance_size(const tactus_instance* instance, size_t* poses, size_t* configurations,
                                              size_t* motions) TACTUS_NOEXCEPT;

enum {
  TACTUS_FORMAT_POMDPX = 1, /**< PomdpX 1.0, for SARSOP and DESPOT; the robot's configuration is fully observed */
  TACTUS_FORMAT_POMDP = 2   /**< Cassandra's, for pomdp-solve and SARSOP */
};

/**
 * The instance as text for public solvers: rewards are costs, negated; the goal is absorbing at reward 0; a motion that
 * can't be made leaves everything as it is at the largest cost of any, so that nothing but the goal is free. The
 * discount is stated. `text`: char (count), the terminating 0 included; some hundred bytes a pose, configuration and
 * motion.
 *
 * TACTUS_INVALID_ARGUMENT (an unknown format), TACTUS_BUFFER_TOO_SMALL.
 */
TACTUS_API tactus_status tactus_instance_export(const tactus_instance* instance, int32_t format, char* text,
                                                size_t capacity, size_t* count) TACTUS_NOEXCEPT;

/** What a policy costs on an instance, run once with the target at each of the poses. */
typedef struct tactus_evaluation {
  uint32_t struct_size;
  uint32_t reserved;    /**< 0 */
  double expected_cost; /**< exact; discounted as the instance's options say */
  double worst_cost;    /**< the same for the pose that costs most */
  double inserted;      /**< share of the poses; where it is below 1 the costs are those until the policy gave up */
  double lower_bound;   /**< admissible value at the start, undiscounted */
  double value;         /**< inadmissible value at the start, undiscounted */
  uint64_t plans;       /**< one for each belief that the policy meets */
  uint64_t expansions;  /**< of all plans */
} tactus_evaluation;

/** Sets `struct_size` to `size`, which is `sizeof *evaluation`, and everything else to 0. */
TACTUS_API tactus_status tactus_evaluation_init(tactus_evaluation* evaluation, size_t size) TACTUS_NOEXCEPT;

/**
 * Runs a solver's policy on the instance, planning anew at every belief with the whole budget. `options`: NULL for the
 * scenario's. Takes up to a budget a belief, of which there are up to a few for each pose.
 *
 * TACTUS_INVALID_ARGUMENT (out of range, NaN), TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_instance_evaluate(const tactus_instance* instance,
                                                  const tactus_planner_options* options,
                                                  tactus_evaluation* evaluation) TACTUS_NOEXCEPT;

/**
 * The least expected cost that any policy can have, discounted as the instance's options say; NAN if more than
 * `most_beliefs` beliefs would have to be solved for it. `*beliefs`: how many were. Some ten microseconds a belief.
 * Policies that make motions which change nothing are left out: with a discount so low that putting costs off pays
 * (where a motion costs less than 1 - discount of what is still to come), one of those may cost less.
 */
TACTUS_API tactus_status tactus_instance_optimum(const tactus_instance* instance, uint64_t most_beliefs,
                                                 double* optimum, uint64_t* beliefs) TACTUS_NOEXCEPT;

/**
 * Two lower bounds of that optimum. `*informed`: the expected cost if the pose were known. `*pairs`: the mean of the
 * optima of pairs of poses, which have to be told apart; at least `*informed`, and at most the optimum, as V* is
 * concave and a belief is a mixture of its pairs. NAN if more than `most_beliefs` beliefs would have to be solved for
 * it. Discounted as the instance's options say.
 */
TACTUS_API tactus_status tactus_instance_bounds(const tactus_instance* instance, uint64_t most_beliefs,
                                                double* informed, double* pairs) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
