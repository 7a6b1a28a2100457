/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_COMPARISON_H
#define TACTUS_CLI_COMPARISON_H

#include "result.h"

enum { most_solvers = 16 };

/* Trials of several solvers at the same poses. `setting` has the names of all, each result that of its own. */
typedef struct {
  run_setting setting;
  run_result results[most_solvers]; /* solver_count of them */
  int solver_count;
} comparison;

/* Makes room for the solvers named, with commas between them. NULL; or what was expected instead. */
const char* name_solvers(const char* names, comparison* c);

run_result* find_solver(comparison* c, const char* name); /* NULL if it is not named */

void free_comparison(comparison* c);

/* Takes out the trials of poses at which not all solvers had theirs. */
void forget_half_done(comparison* c);

/* How a solver did in a phase, and beside the first solver. NAN where there is nothing to tell it from. */
typedef struct {
  int finished;          /* trials that got to the phase's end */
  effort mean;           /* over these */
  int common;            /* of them, those at poses at which the first solver's did too; over these: */
  double cost_ratio;     /* of the sums, as all that follow */
  double cost_ratio_low; /* and its 95 % interval */
  double cost_ratio_high;
  double planning_ratio;
  double calls_ratio;
  double time_per_call_ratio;
} standing;

standing compare_to_first(const comparison* c, int solver, trial_phase phase);

/* Whether every trial came to its end: inserted, or to the hand-over if it was to go no further. */
bool all_finished(const comparison* c);

void print_comparison(FILE* out, const comparison* c);

#endif
