/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RECORD_H
#define TACTUS_CLI_RECORD_H

#include <stdbool.h>
#include <stdio.h>

#include "tactus/tactus.h"

/* Writes one trial as a JSON document that a replay page can draw: the bodies, where they were, and what was believed.
 * Functions that return false have failed in the library; `tactus_last_error` says why. */
typedef struct recording recording;

/* What the recording says of a step beside the action, the observation and the belief after it. */
typedef struct {
  const tactus_planner* planner; /* that has just handed out the action */
  const char* kind;
  double cost_m;
  double planning_s;
  double lower_bound, value; /* of the plan that it is from */
} step_facts;

/* Writes the scenario's bodies and begins the frames. NULL if that failed. `file` stays the caller's. */
recording* record_begin(FILE* file, const tactus_scenario* scenario, const tactus_belief* belief,
                        const double true_pose[7]);

/* The action as far as it went, and back to where the robot retreated; and the belief after it. */
bool record_step(recording* record, const tactus_action* action, const tactus_observation* observation,
                 const tactus_belief* belief, const step_facts* facts);

/* Ends the document and frees the recording. NULL is legal. */
void record_end(recording* record, bool inserted);

#endif
