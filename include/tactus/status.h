/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_STATUS_H
#define TACTUS_STATUS_H

/**
 * Status codes, error texts, and the rules that hold for every function of the library.
 *
 * Units are SI and radians. A joint vector is double[dof], radians or metres, in the order of
 * `tactus_scenario_joint_name`. A pose is double[7] = x y z qx qy qz qw, a unit quaternion; the target's pose is that
 * of its mesh's frame in the robot's base frame.
 *
 * Errors. Functions return a `tactus_status`: 0, a reason why there is no result of the usual kind (1..99), or an error
 * (100 and up). After an error every object is as it was, a handle that would have been created is NULL, and
 * `tactus_last_error` says what was wrong. A pointer must not be NULL unless its function says so
 * (TACTUS_INVALID_ARGUMENT). TACTUS_OUT_OF_MEMORY and TACTUS_INTERNAL may come from any function.
 *
 * Handles. What a function creates is the caller's, to be given to `_destroy`, which accepts NULL. Handles may be
 * destroyed in any order: what is made from a scenario keeps what it needs of it. Strings that are handed out belong to
 * the object they were asked of and live as long as its handle.
 *
 * Arrays go out as (buffer, capacity, count). `capacity` and `*count` are in rows of the shape that the function
 * states, and `*count` is always set to all there is. A buffer that is too small is left alone:
 * TACTUS_BUFFER_TOO_SMALL. NULL with a capacity of 0 asks for the count.
 *
 * Structs begin with `struct_size`, which their `_init` function sets. A field counts only if `struct_size` covers it;
 * fields that it does not cover have their defaults, and are not written. Bytes beyond what this version knows must be
 * 0 where the library reads (TACTUS_STRUCT_SIZE), and are set to 0 where it writes.
 *
 * Threads. Scenarios and actions are constant and may be shared. A belief, planner or world is used by one thread at a
 * time; a second one gets TACTUS_BUSY. Destroying a handle that another thread is using is an error that is not caught.
 */

#include <stddef.h>
#include <stdint.h>

#if defined(__GNUC__)
#define TACTUS_API __attribute__((visibility("default")))
#else
#define TACTUS_API
#endif

#if defined(__cplusplus)
#define TACTUS_NOEXCEPT noexcept
#else
#define TACTUS_NOEXCEPT
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** One of the values below. They never change; there may be more of them in later versions. */
typedef int32_t tactus_status;

enum {
  TACTUS_OK = 0,

  /* 1..99: not an error, but no result of the usual kind */
  TACTUS_GOAL_REACHED = 1,          /**< the task is done: there is no next action */
  TACTUS_NO_INFORMATIVE_ACTION = 2, /**< no action would tell anything or do anything */
  TACTUS_CANCELLED = 3,             /**< `tactus_planner_cancel` came before there was anything to return */

  /* 100..199: the caller's arguments */
  TACTUS_INVALID_ARGUMENT = 100, /**< NULL, NaN, out of range; the text names the argument */
  TACTUS_BUFFER_TOO_SMALL = 101, /**< `*count` says what is needed */
  TACTUS_STRUCT_SIZE = 102,      /**< `struct_size` was not set, or fields are set that this version does not know */
  TACTUS_BUSY = 103,             /**< another thread is using the object */
  TACTUS_STOP_OFF_PATH = 104,    /**< the robot is said to have stopped where the action does not pass */
  TACTUS_WRONG_SCENARIO = 105,   /**< the objects come from different scenarios */

  /* 200..299: files and saved state */
  TACTUS_FILE_NOT_FOUND = 200,
  TACTUS_FILE_UNREADABLE = 201,
  TACTUS_BAD_MESH = 202,
  TACTUS_BAD_ROBOT = 203,
  TACTUS_BAD_SCENARIO = 204,
  TACTUS_BAD_SAVED_STATE = 205,

  /* 300..399: the task as described can't be done */
  TACTUS_START_IN_COLLISION = 300,
  TACTUS_PRIOR_UNREACHABLE = 301,
  TACTUS_MOTION_INFEASIBLE = 302,

  /* 900 and up: the library's or the machine's fault */
  TACTUS_OUT_OF_MEMORY = 900,
  TACTUS_INTERNAL = 901
};

/** "TACTUS_BUSY" and so on; "unknown status" for any other number. A constant. Any thread. */
TACTUS_API const char* tactus_status_name(tactus_status status) TACTUS_NOEXCEPT;

/**
 * What was wrong with the last call in this thread that failed: the function, the argument or file:line, what was found
 * and what was expected. UTF-8 as far as the names of files and the arguments in it are. Never NULL, "" before the
 * first failure. Valid until the next call in this thread fails.
 */
TACTUS_API const char* tactus_last_error(void) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
