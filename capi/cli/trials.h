/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_TRIALS_H
#define TACTUS_CLI_TRIALS_H

#include "episode.h"
#include "options.h"
#include "results_file.h"

/* All trials of a command: of each solver, at the same true poses. */
typedef struct {
  const trial_options* options;
  const trial_setup* setups; /* one a solver */
  run_result* results;       /* the same */
  int solvers;
  FILE* record; /* takes in a recording of the first trial, if not NULL */
  const results_file* file;
} campaign;

/* Runs the trials that the results do not have yet, `options->jobs` at a time, adds them and saves the file after each.
 * Trials of the phase of poses begin where the first solver comes to the hand-over. A trial that fails is one
 * of the results. False if no trial could be run, or one not saved: stderr says why, the results have the others. */
bool run_trials(const campaign* all);

#endif
