/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_TACTUS_H
#define TACTUS_TACTUS_H

/**
 * tactus plans by touch: it tells a robot, one guarded motion at a time, what to touch next until a task is done, from
 * nothing but joint positions and one bit, contact or not. The loop:
 *
 *     tactus_scenario_load("shelf.yaml", &scenario);
 *     tactus_belief_create(scenario, NULL, start, &belief);
 *     tactus_planner_create(scenario, NULL, &planner);
 *     while ((status = tactus_planner_query_action(planner, belief, &action)) == TACTUS_OK) {
 *       ... execute the action guarded, stop at the first contact, note it in `observation` ...
 *       tactus_belief_step(belief, action, &observation);
 *       ... after a contact go back to the waypoint that `tactus_action_retreat` names ...
 *       tactus_action_destroy(action);
 *     }
 *     if (status >= 100) puts(tactus_last_error());   // below 100: the goal is reached, or nothing is worth trying
 *
 * This header includes all others; what holds for every function is said in `status.h`.
 */

#include "tactus/action.h"
#include "tactus/belief.h"
#include "tactus/instance.h"
#include "tactus/planner.h"
#include "tactus/scenario.h"
#include "tactus/status.h"
#include "tactus/world.h"

#define TACTUS_VERSION_MAJOR 0
#define TACTUS_VERSION_MINOR 1
#define TACTUS_VERSION_PATCH 0

#ifdef __cplusplus
extern "C" {
#endif

/** The version of the library that is loaded: 10000 * major + 100 * minor + patch. Any thread. */
TACTUS_API int32_t tactus_version(void) TACTUS_NOEXCEPT;

/** The same as text, "0.1.0". A constant. Any thread. */
TACTUS_API const char* tactus_version_string(void) TACTUS_NOEXCEPT;

enum { TACTUS_LOG_DEBUG = 0, TACTUS_LOG_INFO = 1, TACTUS_LOG_WARNING = 2, TACTUS_LOG_ERROR = 3 };

/**
 * Takes one line of the log, without a newline. May be called from any thread, several at a time; `message` is valid
 * during the call only. It must not throw.
 */
typedef void (*tactus_log_callback)(int32_t level, const char* message, void* context);

/**
 * Sets where the log of the process goes; NULL: nowhere, as at first. `context` (may be NULL) is handed to every call.
 * Any thread; a line that is on its way may still reach the callback that was set before.
 */
TACTUS_API tactus_status tactus_set_log_callback(tactus_log_callback callback, void* context) TACTUS_NOEXCEPT;

#ifdef __cplusplus
}
#endif

#endif
