/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULT_H
#define TACTUS_CLI_RESULT_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Why a trial ended. */
typedef enum {
  trial_goes_on,
  trial_at_goal,
  trial_out_of_actions, /* none would tell anything */
  trial_cancelled,
  trial_failed,
  trial_at_limit_of_actions,
  trial_at_limit_of_travel,
  trial_at_limit_of_time,
  trial_end_count
} trial_end;

const char* trial_end_name(trial_end end); /* for a person */

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
  trial_end ended;
} trial_result;

/* What all trials of a run have in common: trials of two runs may be put together if this is the same. NAN where an
 * option leaves it to the scenario, or nothing is limited. */
typedef struct {
  char scenario[256], solver[32], belief[32];
  double budget_seconds;
  uint64_t budget_expansions;
  double true_pose[6]; /* x y z roll pitch yaw, if it is not drawn */
  double stopping_distance, encoder_error, missed_contacts, false_contacts;
} run_setting;

/* The trials of a run that are done, in the order of their seeds. */
typedef struct {
  run_setting setting;
  trial_result* trials; /* count of them, room for `room` */
  int count, room;
} run_result;

bool has_trial(const run_result* run, uint64_t seed);
bool add_trial(run_result* run, const trial_result* trial); /* false if out of memory */

/* How many trials there are, were inserted, kept the truth; and means over all of them. */
typedef struct {
  int trials, inserted, truth_kept;
  double cost_m, travel_m, rotation_rad, actions, contacts, planner_calls, planning_s, expansions;
} run_summary;

run_summary summarise(const run_result* run);

void print_table(FILE* out, const run_result* run);

#endif
