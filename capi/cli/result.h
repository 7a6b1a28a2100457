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
  trial_at_hand_over,      /* and was to go no further */
  trial_without_hand_over, /* with which it was to begin */
  trial_end_count
} trial_end;

const char* trial_end_name(trial_end end); /* for a person */

/* A trial, or what of it came before and after poses took over from voxels: the hand-over. */
typedef enum { phase_whole, phase_voxels, phase_poses, phase_count } trial_phase;

const char* trial_phase_name(trial_phase phase); /* as options and results have it */

/* What adds up in a trial. NAN where it does not apply, as in a trial that could not begin. */
typedef struct {
  double cost_m;       /* with the scenario's weights */
  double travel_m;     /* of the tool frame, retreats included */
  double rotation_rad; /* of the tool frame */
  double actions;
  double planner_calls; /* queries that planned */
  double planning_s;    /* what these took */
} effort;

extern const effort unknown_effort; /* all NAN */

void add_effort(effort* sum, const effort* other, double times);

/* How one trial went. NAN where a number does not apply. */
typedef struct {
  uint64_t seed;
  double true_pose[7];
  bool inserted;
  bool truth_kept; /* the belief never lost the true pose */
  effort whole;
  effort voxels; /* of this, up to the hand-over */
  int contacts;
  uint64_t expansions;       /* beliefs expanded */
  double slowest_planning_s; /* of a call */
  int late_plans;            /* calls that took over 5 % longer than the budget in seconds, if there is one */
  double stepping_s;         /* what taking in observations took */
  double slowest_step_s;     /* of these */
  double poses_lower_bound;  /* of the first plan on a belief of poses; and its value, which the solver that bounds */
  double poses_value;        /* costs is never above */
  double position_error_m;   /* of the belief's mean */
  double angle_error_rad;
  trial_end ended;
} trial_result;

/* What a phase took. False if the trial did not get to its end. */
bool effort_of_phase(const trial_result* trial, trial_phase phase, effort* taken);

enum { solvers_room = 256 };

/* What all trials of a run have in common: trials of two runs may be put together if this is the same. NAN where an
 * option leaves it to the scenario, or nothing is limited. */
typedef struct {
  char scenario[256], belief[32], phase[32];
  char solver[solvers_room]; /* or several, with commas */
  double budget_seconds;
  uint64_t budget_expansions;
  double true_pose[6]; /* x y z roll pitch yaw, if it is not drawn */
  double stopping_distance, encoder_error, missed_contacts, false_contacts;
  bool has_terms; /* what follows, which the scenario says; results of earlier versions do not have it */
  double cost_metre, cost_radian, cost_action;
  int limit_actions;
  double limit_travel, limit_seconds;
} run_setting;

/* The trials of a run that are done, in the order of their seeds. */
typedef struct {
  run_setting setting;
  trial_result* trials; /* count of them, room for `room` */
  int count, room;
} run_result;

const trial_result* find_trial(const run_result* run, uint64_t seed); /* NULL if there is none */
bool add_trial(run_result* run, const trial_result* trial);           /* false if out of memory */

/* How many trials there are, were inserted, kept the truth, could begin; and means over these, NAN if none could. */
typedef struct {
  int trials, inserted, truth_kept, begun;
  effort mean;
  double contacts, expansions;
  double slowest_planning_s;
  int late_plans;
  double stepping_s, slowest_step_s;
  double certificate; /* median of value / lower bound at the first plans on poses */
} run_summary;

run_summary summarise(const run_result* run);

void print_table(FILE* out, const run_result* run);

#endif
