/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULT_JSON_H
#define TACTUS_CLI_RESULT_JSON_H

#include "json_reader.h"
#include "result.h"

void print_json(FILE* out, const run_result* run);

/* Reads what `print_json` wrote into an empty `run`; its numbers come back with nine digits. */
bool read_json(json_reader* reader, run_result* run);

/* Whether two runs have the same setting, to the digits of the JSON. If not, the first thing that differs: its name as
 * an option has it, and both values. */
typedef struct {
  char name[32];
  char found[300], expected[300];
} setting_difference;

bool same_setting(const run_setting* found, const run_setting* expected, setting_difference* difference);

#endif
