/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_ACTION_H
#define TACTUS_ACTION_H

/**
 * An action: a joint path from the robot's present configuration, to be executed guarded, which means that the robot
 * stops at the first contact. An observation: what the robot reports afterwards. Actions are constant: any thread.
 */

#include "tactus/scenario.h"
#include "tactus/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_action tactus_action;

typedef int32_t tactus_action_kind;

enum {
  TACTUS_ACTION_MOVE = 1,     /**< the tool moves along an axis of the search, from where it is */
  TACTUS_ACTION_TURN = 2,     /**< the tool turns about the approach axis */
  TACTUS_ACTION_SWEEP = 3,    /**< in beside the region in which the target may be, and through it sideways */
  TACTUS_ACTION_POKE = 4,     /**< straight in */
  TACTUS_ACTION_INSERTION = 5 /**< to the seated pose at a supposed pose of the target */
};

/** "move", "turn", "sweep", "poke", "insertion"; "unknown" for any other number. A constant. */
TACTUS_API const char* tactus_action_kind_name(tactus_action_kind kind) TACTUS_NOEXCEPT;

/* --- the observation */

/**
 * What a robot reports after an action. The joints stand in an array of the caller's, so that a robot may have any
 * number of them: after `tactus_observation_init` set `joints` and `joint_count`.
 */
typedef struct tactus_observation {
  uint32_t struct_size;
  int32_t contact;      /**< 1: the robot stopped because it touched something; 0: it did not */
  uint64_t joint_count; /**< dof: the length of `joints` */
  double* joints; /**< where it stopped, rad or m (dof); of the caller's, written by `tactus_world_execute` only */
} tactus_observation;

/** Sets `struct_size` to `size`, which is `sizeof *observation`, and everything else to 0 and NULL. */
TACTUS_API tactus_status tactus_observation_init(tactus_observation* observation, size_t size) TACTUS_NOEXCEPT;

/* --- the action */

typedef struct tactus_action_properties {
  uint32_t struct_size;
  tactus_action_kind kind;
  uint64_t id;                /**< of the path: equal paths have equal ids */
  uint64_t waypoints;         /**< number of them, at least 1 */
  double length;              /**< m that the tool frame goes if nothing is touched */
  double duration;            /**< s that it takes then */
  double full_cost;           /**< of going all the way */
  double expected_cost;       /**< of it and of all that follows, as the planner saw it: until the goal, on voxels until
                                   the hand-over to poses */
  double contact_probability; /**< that it touches the target, as the planner saw it */
} tactus_action_properties;

/** Sets `struct_size` to `size`, which is `sizeof *properties`, and everything else to 0. */
TACTUS_API tactus_status tactus_action_properties_init(tactus_action_properties* properties,
                                                       size_t size) TACTUS_NOEXCEPT;

/** TACTUS_STRUCT_SIZE. */
TACTUS_API tactus_status tactus_action_info(const tactus_action* action,
                                            tactus_action_properties* properties) TACTUS_NOEXCEPT;

/**
 * The joint path, from the configuration at which the belief was. Neighbours are so near that no point of the robot
 * moves more than the scenario's step between them; the robot goes straight in joint space. `waypoints`: double (count
 * x dof).
 */
TACTUS_API tactus_status tactus_action_waypoints(const tactus_action* action, double* waypoints, size_t capacity,
                                                 size_t* count) TACTUS_NOEXCEPT;

/**
 * Seconds from the start at which each waypoint is passed, within the joints' velocity limits and the scenario's speeds
 * and accelerations; starts and ends at rest. `times`: double (count), as many as waypoints.
 */
TACTUS_API tactus_status tactus_action_times(const tactus_action* action, double* times, size_t capacity,
                                             size_t* count) TACTUS_NOEXCEPT;

/**
 * The index of the waypoint to which the robot goes back after this observation: the last one that is certainly free.
 * After a contact go back along the path to there; that is where `tactus_belief_step` takes the robot to be. Without a
 * contact it is the last waypoint that the robot passed, and the robot stays where it is. Actions that are planned for
 * a belief whose observations contradict each other have it go back farther: the robot may travel on after contacts.
 *
 * TACTUS_INVALID_ARGUMENT (a NaN, a wrong number of joints), TACTUS_STOP_OFF_PATH, TACTUS_STRUCT_SIZE.
 */
TACTUS_API tactus_status tactus_action_retreat(const tactus_action* action, const tactus_observation* observation,
                                               size_t* waypoint) TACTUS_NOEXCEPT;

/** The action as bytes, to be kept or sent elsewhere. `bytes`: uint8_t (count). */
TACTUS_API tactus_status tactus_action_save(const tactus_action* action, uint8_t* bytes, size_t capacity,
                                            size_t* count) TACTUS_NOEXCEPT;

/**
 * The action that was saved as these `size` bytes, in the same scenario.
 *
 * TACTUS_BAD_SAVED_STATE, TACTUS_WRONG_SCENARIO.
 */
TACTUS_API tactus_status tactus_action_restore(const tactus_scenario* scenario, const uint8_t* bytes, size_t size,
                                               tactus_action** action) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_action_destroy(tactus_action* action) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
