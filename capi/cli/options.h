/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_OPTIONS_H
#define TACTUS_CLI_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "result.h"

enum { most_jobs = 256 };

/* What `tactus run` or `tactus compare` was asked for. Strings are those of the command line; NULL and 0 where an
 * option was not given. */
typedef struct {
  const char* scenario;
  const char* solver;
  const char* solvers; /* with commas */
  trial_phase phase;
  const char* belief;
  const char* json;
  const char* record;
  const char* tables;
  bool resume;
  int trials;
  int jobs;
  uint64_t seed;
  double budget_seconds;
  uint64_t budget_expansions;
  bool has_true_pose;
  double true_pose[6]; /* x y z roll pitch yaw */
  /* of the simulated robot; negative where not given */
  double stopping_distance, encoder_error; /* m */
  double missed_contacts, false_contacts;  /* shares */
} trial_options;

extern const char* const usage;

bool is_option(const char* word); /* not a value: begins with -- */

/* Reads what follows `tactus` and the command. On a mistake says what is wrong on stderr and returns false. */
bool parse_options(const char* command, int argc, char** argv, trial_options* options);

#endif
