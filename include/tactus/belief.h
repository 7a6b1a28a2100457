/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_BELIEF_H
#define TACTUS_BELIEF_H

/**
 * A belief: the robot's configuration, and what is known of the target's pose. One thread at a time (TACTUS_BUSY, from
 * every function here that takes a belief).
 */

#include "tactus/action.h"
#include "tactus/scenario.h"
#include "tactus/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_belief tactus_belief;

typedef int32_t tactus_belief_kind;

enum {
  TACTUS_BELIEF_HIERARCHICAL = 1, /**< voxels that the target may occupy; cells of poses once there are few */
  TACTUS_BELIEF_PARTICLES = 2     /**< cells of poses from the start */
};

typedef struct tactus_belief_options {
  uint32_t struct_size;
  tactus_belief_kind kind;
} tactus_belief_options;

/** Sets `struct_size` to `size`, which is `sizeof *options`, and the rest to the library's defaults: hierarchical. */
TACTUS_API tactus_status tactus_belief_options_init(tactus_belief_options* options, size_t size) TACTUS_NOEXCEPT;

/** The scenario's own options. TACTUS_STRUCT_SIZE. */
TACTUS_API tactus_status tactus_scenario_belief_options(const tactus_scenario* scenario,
                                                        tactus_belief_options* options) TACTUS_NOEXCEPT;

/**
 * The belief before anything is touched: the target is anywhere in the prior, the robot at `q`, double (dof).
 * `options`: NULL for the scenario's.
 *
 * TACTUS_INVALID_ARGUMENT (a NaN, an unknown kind), TACTUS_START_IN_COLLISION, TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_belief_create(const tactus_scenario* scenario, const tactus_belief_options* options,
                                              const double* q, tactus_belief** belief) TACTUS_NOEXCEPT;

/** An independent copy. */
TACTUS_API tactus_status tactus_belief_clone(const tactus_belief* belief, tactus_belief** clone) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_belief_destroy(tactus_belief* belief) TACTUS_NOEXCEPT;

/* --- what happens to it */

/**
 * Takes in what the robot reported after it executed `action`. The belief's configuration becomes the last free
 * waypoint after a contact (see `tactus_action_retreat`), and where the robot stopped without one. A stop without
 * contact midway is legal: what was travelled is free. Observations that contradict each other do not empty the
 * belief. Its health says so, and the robot is one that errs from then on, as it is from the first if the scenario says
 * that it misses contacts or feels some where there are none: every pose of the prior keeps a weight, by how likely the
 * history is from there, the belief is in its phase of poses, and what the likeliest explanation takes for wrong is
 * doubted (it need not be the last observation).
 *
 * Some 0.1 s; the first steps of a wide prior 1 to 5 s, in five dimensions more than ten where no table of contact is
 * there yet. Splitting cells, looking into them and proving that the tool is seated end after a counted amount of work
 * of the contact engine, the same on every machine and any number of threads, and go on at the next observation; on one
 * thread single observations were seen to take 12 s in four dimensions and 26 s in five. `belief.threads` shortens
 * that.
 *
 * TACTUS_STOP_OFF_PATH, TACTUS_INVALID_ARGUMENT (a NaN, a wrong number of joints), TACTUS_WRONG_SCENARIO,
 * TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_belief_step(tactus_belief* belief, const tactus_action* action,
                                            const tactus_observation* observation) TACTUS_NOEXCEPT;

/**
 * The robot was moved to `q`, double (dof), by somebody else, a jog for instance. Nothing is learned from it.
 *
 * TACTUS_INVALID_ARGUMENT (a NaN), TACTUS_START_IN_COLLISION.
 */
TACTUS_API tactus_status tactus_belief_set_configuration(tactus_belief* belief, const double* q) TACTUS_NOEXCEPT;

/* --- what it says */

/** The robot's configuration. `q`: double (dof). */
TACTUS_API tactus_status tactus_belief_configuration(const tactus_belief* belief, double* q, size_t capacity,
                                                     size_t* count) TACTUS_NOEXCEPT;

enum {
  TACTUS_PHASE_VOXELS = 1, /**< known are voxels that the target may occupy */
  TACTUS_PHASE_POSES = 2   /**< known are cells of poses that the target may have */
};

enum {
  TACTUS_HEALTH_GOOD = 0,
  TACTUS_HEALTH_CONTRADICTED = 1 /**< the observations contradicted each other: some are doubted */
};

/** A belief in numbers. Six numbers of a pose are x y z (m) and roll pitch yaw (rad, as in `tactus_pose_from_rpy`). */
typedef struct tactus_summary {
  uint32_t struct_size;
  int32_t phase;              /**< TACTUS_PHASE_VOXELS or TACTUS_PHASE_POSES */
  int32_t health;             /**< TACTUS_HEALTH_GOOD or TACTUS_HEALTH_CONTRADICTED */
  uint32_t doubted;           /**< observations that are: see `tactus_belief_history` */
  uint64_t observations;      /**< taken in */
  uint64_t contacts;          /**< of them with contact */
  uint64_t possibly_occupied; /**< voxels; 0 in the pose phase */
  double volume;              /**< of these voxels, m^3; 0 in the pose phase */
  uint64_t cells;             /**< of poses; 0 in the voxel phase */
  double bits;                /**< entropy of the pose in steps of the task's tolerances: log2 of how many it spans */
  double mean[6];             /**< of the target's pose; angles: circular mean */
  double extent[6];           /**< full widths */
  double covariance[36];      /**< 6 x 6, row by row */
} tactus_summary;

/** Sets `struct_size` to `size`, which is `sizeof *summary`, and everything else to 0. */
TACTUS_API tactus_status tactus_summary_init(tactus_summary* summary, size_t size) TACTUS_NOEXCEPT;

/** TACTUS_STRUCT_SIZE. */
TACTUS_API tactus_status tactus_belief_summary(const tactus_belief* belief, tactus_summary* summary) TACTUS_NOEXCEPT;

/** The centres of the voxels that the target may occupy, base frame, m; none in the pose phase. `centres`: double
 * (count x 3). */
TACTUS_API tactus_status tactus_belief_voxels(const tactus_belief* belief, double* centres, size_t capacity,
                                              size_t* count) TACTUS_NOEXCEPT;

/** The centres of the cells of poses that the target may have; none in the voxel phase. `poses`: double (count x 7). */
TACTUS_API tactus_status tactus_belief_poses(const tactus_belief* belief, double* poses, size_t capacity,
                                             size_t* count) TACTUS_NOEXCEPT;

/**
 * The parts of the belief that hang together, the heaviest first; none in the voxel phase. `modes`: double (count x
 * 13), of each its share of the belief (they sum to one), then the mean and the full widths of x y z roll pitch yaw.
 * About a microsecond a cell.
 */
TACTUS_API tactus_status tactus_belief_modes(const tactus_belief* belief, double* modes, size_t capacity,
                                             size_t* count) TACTUS_NOEXCEPT;

/**
 * What was done and felt, in order. `events`: int32_t (count x 3), of each the kind of the action
 * (`tactus_action_kind`), 1 for a contact, and 1 if it is doubted: the likeliest explanation of all has it wrong.
 */
TACTUS_API tactus_status tactus_belief_history(const tactus_belief* belief, int32_t* events, size_t capacity,
                                               size_t* count) TACTUS_NOEXCEPT;

/** Where the robot stopped at each event of the history. `joints`: double (count x dof). */
TACTUS_API tactus_status tactus_belief_stops(const tactus_belief* belief, double* joints, size_t capacity,
                                             size_t* count) TACTUS_NOEXCEPT;

/** `*goal` is 1 if at the present configuration the tool is seated for every pose that the target may still have, else
 * 0. */
TACTUS_API tactus_status tactus_belief_is_goal(const tactus_belief* belief, int32_t* goal) TACTUS_NOEXCEPT;

/** `*contained` is 1 if the target may have this pose, double (7), as far as is known, else 0. TACTUS_INVALID_ARGUMENT.
 */
TACTUS_API tactus_status tactus_belief_contains(const tactus_belief* belief, const double pose[7],
                                                int32_t* contained) TACTUS_NOEXCEPT;

typedef int32_t tactus_likelihood;

/** How the outcomes of an action are weighed on voxels; planners do it as the scenario's `belief.likelihood` says. */
enum {
  TACTUS_LIKELIHOOD_PAPER = 1,     /**< the paper's equations */
  TACTUS_LIKELIHOOD_CALIBRATED = 2 /**< of sampled feasible poses, the share that is first touched at each waypoint; the
                                        paper's where fewer than ten are found */
};

/**
 * What the belief expects of an action that begins where the robot is: by waypoint the probability that the first
 * contact is there, and last that there is none; they sum to one. In the pose phase it is the share of poses drawn for
 * planning, whichever `likelihood`. `seed`: of the poses drawn. `probabilities`: double (waypoints + 1). Takes about as
 * long as to begin a plan.
 *
 * TACTUS_INVALID_ARGUMENT (an unknown likelihood), TACTUS_WRONG_SCENARIO.
 */
TACTUS_API tactus_status tactus_belief_forecast(const tactus_belief* belief, const tactus_action* action,
                                                tactus_likelihood likelihood, uint64_t seed, double* probabilities,
                                                size_t capacity, size_t* count) TACTUS_NOEXCEPT;

/* --- keeping it */

/** The whole belief as bytes, with a version and a checksum. `bytes`: uint8_t (count). */
TACTUS_API tactus_status tactus_belief_save(const tactus_belief* belief, uint8_t* bytes, size_t capacity,
                                            size_t* count) TACTUS_NOEXCEPT;

/**
 * The belief that was saved as these `size` bytes, in the same scenario. It acts as the saved one would have.
 *
 * TACTUS_BAD_SAVED_STATE, TACTUS_WRONG_SCENARIO.
 */
TACTUS_API tactus_status tactus_belief_restore(const tactus_scenario* scenario, const uint8_t* bytes, size_t size,
                                               tactus_belief** belief) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
