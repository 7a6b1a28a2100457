/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef TACTUS_CLI_RESULT_JSON_H
#define TACTUS_CLI_RESULT_JSON_H

#include "result.h"
#include "results_file.h"

/* The results of `tactus run`, a run_result; its numbers come back with nine digits. */
extern const results_format run_format;

/* The members of a trial, and the options that a setting has beside its names; no braces. A function that returns false
 * has said why. */
void print_trial(FILE* out, const trial_result* trial);
bool read_trial(json_reader* reader, trial_result* trial);
void print_trial_end(FILE* out, const trial_result* trial);
bool read_trial_end(json_reader* reader, trial_result* trial);
void print_options(FILE* out, const run_setting* setting);
bool read_options(json_reader* reader, run_setting* setting);

/* Adds a trial that was read to those before it. */
bool take_trial(json_reader* reader, const trial_result* trial, run_result* run);

/* Whether two runs have the same setting, to the digits of the JSON and as far as what was found has it. If not, the
 * first thing that differs: its name as an option has it, and both values. */
typedef struct {
  char name[32];
  char found[300], expected[300];
  const char* said_by; /* what expects it */
} setting_difference;

bool same_setting(const run_setting* found, const run_setting* expected, setting_difference* difference);

#endif
