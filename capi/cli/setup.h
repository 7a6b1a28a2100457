/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_SETUP_H
#define TACTUS_CLI_SETUP_H

#include "episode.h"
#include "options.h"

/* A scenario that is loaded, with what the command line says over it. */
typedef struct {
  tactus_scenario* scenario;
  double* start;
  trial_setup trial;
} loaded_setup;

/* False: stderr says why. To be freed in either case. */
bool load_setup(const trial_options* options, loaded_setup* setup);
void free_setup(loaded_setup* setup);

run_setting setting_of(const trial_options* options, const loaded_setup* setup);

#endif
