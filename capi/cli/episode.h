/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_EPISODE_H
#define TACTUS_CLI_EPISODE_H

#include <stdio.h>

#include "result.h"
#include "tactus/tactus.h"

/* What all trials of a run have in common. */
typedef struct {
  const tactus_scenario* scenario;
  tactus_belief_options belief;
  tactus_planner_options planner; /* its seed is the trial's */
  tactus_world_options world;     /* the same */
  tactus_costs costs;
  tactus_limits limits;
  const double* start; /* dof */
  size_t dof;
} trial_setup;

/* One trial from the start to its end: `seed` is the planner's and the world's, the target is at `true_pose`. Progress
 * goes to stderr, a recording to `record` if that is not NULL. False if there could be no trial: stderr says why. */
bool run_trial(const trial_setup* setup, uint64_t seed, const double true_pose[7], FILE* record, trial_result* result);

#endif
