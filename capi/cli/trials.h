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
 * Trials of the phase of poses begin where the first solver comes to the hand-over. False if a trial could not be run
 * or saved: stderr says why, the results have those that were. */
bool run_trials(const campaign* all);

#endif
