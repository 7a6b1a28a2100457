/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESUME_H
#define TACTUS_CLI_RESUME_H

#include "options.h"
#include "tactus/tactus.h"

/* Whether trials that were loaded from `options->json` belong to what is asked for now. False: stderr says why not. */

bool settings_agree(const trial_options* options, const run_setting* found, const run_setting* expected);

/* Of a run: whether its seeds are asked for, and the scenario still draws their true poses. */
bool trials_belong(const trial_options* options, const tactus_scenario* scenario, const run_result* run);

#endif
