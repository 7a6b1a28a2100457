/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_SCENARIO_H
#define TACTUS_SCENARIO_H

/**
 * A scenario: everything that does not change. The robot, its tool, the static world, the target and where it may be,
 * what may be done, and the options. Constant: any number of threads may use one.
 */

#include "tactus/status.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct tactus_scenario tactus_scenario;

/* --- making one */

/**
 * Reads a scenario file (YAML), the robot and the meshes that it names, and makes all ready; takes seconds. Paths in
 * the file are relative to its folder. Everything that is wrong in the file is reported at once.
 *
 * Meshes are read by another program, tactus-import-mesh, which belongs in a folder `tactus` beside libtactus.so: a
 * child process for each file, gone when this returns. A program that handles SIGCHLD sees them end, and may reap them.
 *
 * TACTUS_FILE_NOT_FOUND, TACTUS_FILE_UNREADABLE, TACTUS_BAD_SCENARIO, TACTUS_BAD_ROBOT, TACTUS_BAD_MESH,
 * TACTUS_START_IN_COLLISION, TACTUS_PRIOR_UNREACHABLE.
 */
TACTUS_API tactus_status tactus_scenario_load(const char* path, tactus_scenario** scenario) TACTUS_NOEXCEPT;

/** The same from text; its paths are relative to `base_dir`, "": to where the process is. Errors as for loading. */
TACTUS_API tactus_status tactus_scenario_parse(const char* yaml, const char* base_dir,
                                               tactus_scenario** scenario) TACTUS_NOEXCEPT;

/**
 * Everything that is wrong with a scenario file, as text, one line a mistake; "" if nothing is. A file that is missing
 * or makes no sense is a finding, not an error of this function. Takes as long as loading. `text`: char (count), the
 * terminating 0 included: `*count` is 1 if nothing is wrong.
 *
 * TACTUS_BUFFER_TOO_SMALL.
 */
TACTUS_API tactus_status tactus_scenario_check(const char* path, char* text, size_t capacity,
                                               size_t* count) TACTUS_NOEXCEPT;

/** NULL is legal. */
TACTUS_API void tactus_scenario_destroy(tactus_scenario* scenario) TACTUS_NOEXCEPT;

/* --- what it says */

/** The scenario's name: the file's stem unless the file says otherwise. Lives as long as the handle. */
TACTUS_API tactus_status tactus_scenario_name(const tactus_scenario* scenario, const char** name) TACTUS_NOEXCEPT;

/** Degrees of freedom: the length of every joint vector. */
TACTUS_API tactus_status tactus_scenario_dof(const tactus_scenario* scenario, size_t* dof) TACTUS_NOEXCEPT;

/** The name of joint `joint`, of {0 .. dof-1}. Lives as long as the scenario's handle. */
TACTUS_API tactus_status tactus_scenario_joint_name(const tactus_scenario* scenario, size_t joint,
                                                    const char** name) TACTUS_NOEXCEPT;

/**
 * The limits of joint `joint`: positions in rad or m (continuous joints: -INFINITY and INFINITY), velocity in rad/s or
 * m/s.
 */
TACTUS_API tactus_status tactus_scenario_joint_limits(const tactus_scenario* scenario, size_t joint, double* lower,
                                                      double* upper, double* velocity) TACTUS_NOEXCEPT;

/** The configuration in which the scenario has the robot start. `q`: double (dof). */
TACTUS_API tactus_status tactus_scenario_start(const tactus_scenario* scenario, double* q, size_t capacity,
                                               size_t* count) TACTUS_NOEXCEPT;

/** What a motion costs: `metre` a metre that the tool frame goes, `radian` a radian it turns, `action` an action. */
typedef struct tactus_costs {
  uint32_t struct_size;
  uint32_t reserved; /**< 0 */
  double metre;
  double radian;
  double action;
} tactus_costs;

/** When an episode is to be given up: after so many actions, metres of the tool frame, seconds. */
typedef struct tactus_limits {
  uint32_t struct_size;
  int32_t actions;
  double travel;  /**< m */
  double seconds; /**< s */
} tactus_limits;

/** Sets `struct_size` to `size`, which is `sizeof *costs`, and everything else to 0. */
TACTUS_API tactus_status tactus_costs_init(tactus_costs* costs, size_t size) TACTUS_NOEXCEPT;
TACTUS_API tactus_status tactus_limits_init(tactus_limits* limits, size_t size) TACTUS_NOEXCEPT;

/** TACTUS_STRUCT_SIZE. */
TACTUS_API tactus_status tactus_scenario_costs(const tactus_scenario* scenario, tactus_costs* costs) TACTUS_NOEXCEPT;
TACTUS_API tactus_status tactus_scenario_limits(const tactus_scenario* scenario, tactus_limits* limits) TACTUS_NOEXCEPT;

/* --- poses */

/** Draws a pose of the target by the prior; the same for the same seed, on every machine. */
TACTUS_API tactus_status tactus_scenario_sample_pose(const tactus_scenario* scenario, uint64_t seed,
                                                     double pose[7]) TACTUS_NOEXCEPT;

/** From x y z in metres and roll pitch yaw in radians, about the fixed axes x, then y, then z, as in a URDF. */
TACTUS_API tactus_status tactus_pose_from_rpy(const double xyzrpy[6], double pose[7]) TACTUS_NOEXCEPT;

/* --- keeping what was worked out */

/**
 * Where the tool touches targets all over the prior, as beliefs have worked it out so far for motions along the axes of
 * the base: with it the next program's beliefs take in such motions in milliseconds at once. It makes no difference to
 * what they answer. `bytes`: uint8_t (count); the count may grow between two calls while beliefs step in other threads.
 */
TACTUS_API tactus_status tactus_scenario_save_tables(const tactus_scenario* scenario, uint8_t* bytes, size_t capacity,
                                                     size_t* count) TACTUS_NOEXCEPT;

/**
 * Takes in what was saved, in the place of what has been worked out so far. The scenario counts as constant all the
 * same: any number of threads may use it meanwhile.
 *
 * TACTUS_BAD_SAVED_STATE, TACTUS_WRONG_SCENARIO (another tool, target, prior or size of cells); then nothing has
 * changed.
 */
TACTUS_API tactus_status tactus_scenario_restore_tables(const tactus_scenario* scenario, const uint8_t* bytes,
                                                        size_t size) TACTUS_NOEXCEPT;

/* --- what to draw */

typedef int32_t tactus_body_kind;

enum {
  TACTUS_BODY_ROBOT = 1, /**< a link that has a shape */
  TACTUS_BODY_TOOL = 2,  /**< the tool */
  TACTUS_BODY_WORLD = 3, /**< a part of the static world */
  TACTUS_BODY_TARGET = 4 /**< what is searched for */
};

/** The number of rigid bodies in the scenario: links, the tool, the static world, the target. */
TACTUS_API tactus_status tactus_scenario_body_count(const tactus_scenario* scenario, size_t* count) TACTUS_NOEXCEPT;

/** Name and kind of body `body`, of {0 .. body_count-1}. The name lives as long as the scenario's handle. */
TACTUS_API tactus_status tactus_scenario_body_name(const tactus_scenario* scenario, size_t body,
                                                   const char** name) TACTUS_NOEXCEPT;
TACTUS_API tactus_status tactus_scenario_body_kind(const tactus_scenario* scenario, size_t body,
                                                   tactus_body_kind* kind) TACTUS_NOEXCEPT;

/**
 * The vertices of a body, in its own frame, metres; and its triangles, each three indices of vertices,
 * counter-clockwise seen from outside. `vertices`: double (count x 3). `triangles`: int32_t (count x 3).
 */
TACTUS_API tactus_status tactus_scenario_body_vertices(const tactus_scenario* scenario, size_t body, double* vertices,
                                                       size_t capacity, size_t* count) TACTUS_NOEXCEPT;
TACTUS_API tactus_status tactus_scenario_body_triangles(const tactus_scenario* scenario, size_t body,
                                                        int32_t* triangles, size_t capacity,
                                                        size_t* count) TACTUS_NOEXCEPT;

/**
 * Where the bodies are in the robot's base frame when the robot is at `q`, double (dof), and the target at
 * `target_pose`, double (7). `poses`: double (count x 7), one row a body.
 *
 * TACTUS_INVALID_ARGUMENT (a NaN, a quaternion whose norm is not 1), TACTUS_BUFFER_TOO_SMALL.
 */
TACTUS_API tactus_status tactus_scenario_body_poses(const tactus_scenario* scenario, const double* q,
                                                    const double target_pose[7], double* poses, size_t capacity,
                                                    size_t* count) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
