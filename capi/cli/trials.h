/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_TRIALS_H
#define TACTUS_CLI_TRIALS_H

#include "episode.h"
#include "options.h"

/* Runs the trials that were asked for and that `result` does not have yet, `options->jobs` at a time, and adds them to
 * it. `save` is called after each with what there is, never twice at a time. A recording of the first goes to `record`
 * if that is not NULL. False if a trial could not be run or saved: stderr says why, `result` has those that were. */
bool run_trials(const trial_setup* setup, const run_options* options, FILE* record,
                bool (*save)(const run_options*, const run_result*), run_result* result);

#endif
