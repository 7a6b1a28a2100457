/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULT_H
#define TACTUS_CLI_RESULT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* How one trial went. NAN where a number does not apply. */
typedef struct {
  uint64_t seed;
  double true_pose[7];
  bool inserted;
  bool truth_kept;     /* the belief never lost the true pose */
  double cost_m;       /* with the scenario's weights */
  double travel_m;     /* of the tool frame, retreats included */
  double rotation_rad; /* of the tool frame */
  int actions;
  int contacts;
  uint64_t planner_calls;  /* queries that planned */
  double planning_s;       /* what these took */
  uint64_t expansions;     /* beliefs expanded in them */
  double phase1_cost_m;    /* the cost at which poses took over from voxels */
  double position_error_m; /* of the belief's mean */
  double angle_error_rad;
  const char* ended; /* why, for a person */
} trial_result;

/* All trials of a run. */
typedef struct {
  const char* scenario;
  const char* solver;
  const char* belief;
  const trial_result* trials;
  int count;
} run_result;

/* How many trials were inserted, kept the truth; and means over all of them. */
typedef struct {
  int inserted;
  int truth_kept;
  double cost_m, travel_m, rotation_rad, actions, contacts, planner_calls, planning_s, expansions;
} run_summary;

run_summary summarise(const run_result* run);

void print_json(FILE* out, const run_result* run);
void print_table(FILE* out, const run_result* run);

#endif
