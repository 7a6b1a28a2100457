/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULTS_FILE_H
#define TACTUS_CLI_RESULTS_FILE_H

#include "result.h"

/* The results of a run in a file that is whole at every moment. False: stderr says why. */

/* Whether there is a file at `path` that can be replaced, or none: not a pipe, a device or "-" for stdout. */
bool is_replaceable(const char* path);

/* Puts the results in the place of what the file holds, at once: they are first written beside it. */
bool save_results(const char* path, const run_result* run);

/* Reads a file that may be there into an empty `run`. */
bool load_results(const char* path, run_result* run);

/* Whether what was loaded from `path` is part of a run of this setting with `count` seeds from `first` on. */
bool trials_belong(const char* path, const run_result* run, const run_setting* setting, uint64_t first, int count);

#endif
