/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_WORLD_H
#define TACTUS_WORLD_H

/**
 * A world: a simulated robot, and a target at a pose that the planner does not know. It takes the place of the robot in
 * tests and studies, and shares no contact code with the planner. One thread at a time (TACTUS_BUSY).
 */

#include "tactus/action.h"
#include "tactus/scenario.h"
#include "tactus/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_world tactus_world;

typedef struct tactus_world_options {
  uint32_t struct_size;
  int32_t fineness; /**< contacts are looked for at so many times finer steps than an action's waypoints, and no longer
                         ones than the scenario's stop tolerance; > 0 */
  uint64_t seed;    /**< of what chance decides: the same seed and the same actions give the same observations */
  /* What the robot really does, whatever the scenario's key of that name says; negative: what it says. */
  double stopping_distance; /**< m that a point of the robot may travel on after the first contact */
  double encoder_error;     /**< m by which the reported joints may put a point of the robot off, its tool included */
  double missed_contacts;   /**< share of motions in which no contact is felt, to their ends; at most 0.5 */
  double false_contacts;    /**< share of motions that are stopped by a contact that was none; at most 0.5 */
} tactus_world_options;

/** Sets `struct_size` to `size`, which is `sizeof *options`, and the rest to the library's defaults. */
TACTUS_API tactus_status tactus_world_options_init(tactus_world_options* options, size_t size) TACTUS_NOEXCEPT;

/**
 * The robot at the scenario's start, the target at `true_pose`, double (7), anywhere in the prior. `options`: NULL for
 * the defaults.
 *
 * TACTUS_INVALID_ARGUMENT (a NaN, a pose outside the prior, an option out of its range), TACTUS_START_IN_COLLISION (the
 * robot's start touches the target), TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_world_create(const tactus_scenario* scenario, const double true_pose[7],
                                             const tactus_world_options* options, tactus_world** world) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_world_destroy(tactus_world* world) TACTUS_NOEXCEPT;

/**
 * Executes an action guarded: stops at the first contact that it feels and reports where, into the array that
 * `observation->joints` points to; then goes back to the last free waypoint, as a robot's driver would. A missed
 * contact is missed to the end of the action; a touch that is there when an action begins is felt only after the robot
 * has been clear of it.
 *
 * TACTUS_BUFFER_TOO_SMALL (`joint_count` below dof), TACTUS_WRONG_SCENARIO, TACTUS_STRUCT_SIZE, TACTUS_STOP_OFF_PATH
 * (the encoders are off by more than the scenario allows), and TACTUS_INVALID_ARGUMENT if the action does not begin
 * where the robot is.
 */
TACTUS_API tactus_status tactus_world_execute(tactus_world* world, const tactus_action* action,
                                              tactus_observation* observation) TACTUS_NOEXCEPT;

/** `*inserted` is 1 if the tool got to the seated pose and touched nothing on the way, felt or not, else 0. */
TACTUS_API tactus_status tactus_world_inserted(const tactus_world* world, int32_t* inserted) TACTUS_NOEXCEPT;

/** What the tool frame has gone (m) and turned (rad) so far, retreats included. */
TACTUS_API tactus_status tactus_world_travelled(const tactus_world* world, double* metres,
                                                double* radians) TACTUS_NOEXCEPT;

/** Where the target really is. */
TACTUS_API tactus_status tactus_world_true_pose(const tactus_world* world, double pose[7]) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
