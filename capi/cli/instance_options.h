/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_INSTANCE_OPTIONS_H
#define TACTUS_CLI_INSTANCE_OPTIONS_H

#include <stdbool.h>

#include "tactus/tactus.h"

/* What `tactus --help` says of the options below; to follow `usage`. */
extern const char* const instance_usage;

/* What `tactus export` or `tactus evaluate` was asked for; NULL and 0 where an option was not given. */
typedef struct {
  const char* scenario;
  tactus_instance_options instance;
  const char* pomdpx; /* export */
  const char* pomdp;
  const char* solver; /* evaluate */
  const char* json;
  uint64_t budget_expansions;
  uint64_t most_beliefs;
} instance_options;

/* Reads what follows the command. On a mistake says what is wrong on stderr and returns false. */
bool parse_instance_options(const char* command, int argc, char** argv, instance_options* options);

/* Loads the scenario and makes the instance; saying so, and what went wrong, on stderr. */
bool load_instance(const char* command, const instance_options* options, tactus_scenario** scenario,
                   tactus_instance** instance);

#endif
