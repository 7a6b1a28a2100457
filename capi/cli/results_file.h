/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULTS_FILE_H
#define TACTUS_CLI_RESULTS_FILE_H

#include "result.h"

/* The results of a run in a file that is whole at every moment. False: stderr says why. */

/* Whether there is a file at `path` that can be replaced, or none: not a pipe, a device or "-" for stdout. */
bool is_replaceable(const char* path);

/* Puts the results in the place of what the file holds, at once: they are first written beside it. */
bool save_results(const char* path, const run_result* run);

/* Takes over the trials of a file that may be there. `run` has its setting and no trials; those of the file must be of
 * the same setting, with seeds of `first` to `first + count - 1`. The file is left as it is. */
bool take_over_results(const char* path, uint64_t first, int count, run_result* run);

#endif
