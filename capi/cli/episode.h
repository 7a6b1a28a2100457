/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_EPISODE_H
#define TACTUS_CLI_EPISODE_H

#include <stdio.h>

#include "result.h"
#include "tactus/tactus.h"

/* What all trials of a solver have in common. */
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

/* A belief at the hand-over, and the actions that led to it: with them a new world comes to where the robot was. */
typedef struct {
  tactus_belief* belief;   /* NULL if there was no hand-over */
  tactus_action** actions; /* count of them, room for `room` */
  int count, room;
  bool failed; /* the trial that was to lead to it */
} head_start;

void free_head_start(head_start* start);

/* How a trial is played. */
typedef struct {
  bool until_hand_over;
  const head_start* from; /* NULL: from the scenario's start */
  head_start* keep;       /* takes in what was done until the hand-over, if not NULL */
  FILE* record;           /* takes in a recording, if not NULL */
} trial_course;

/* One trial: `seed` is the planner's and the world's, the target is at `true_pose`. What it costs to get to where it
 * begins does not count. Progress goes to stderr, and why a trial failed. False if no other trial could do better. */
bool run_trial(const trial_setup* setup, uint64_t seed, const double true_pose[7], const trial_course* course,
               trial_result* result);

#endif
