/* SPDX-License-Identifier: BSD-3-Clause */
#include "resume.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "json.h"
#include "result_json.h"

bool settings_agree(const trial_options* options, const run_setting* found, const run_setting* expected) {
  setting_difference difference;
  if (same_setting(found, expected, &difference)) return true;
  fprintf(stderr,
          "tactus: %s: found trials with %s %s, expected %s as %s now; ask for the same to go on with them, or write "
          "to another file\n",
          options->json, difference.name, difference.found, difference.expected, difference.said_by);
  return false;
}

static bool is_asked_for(const trial_options* options, uint64_t seed) {
  if (seed - options->seed < (uint64_t)options->trials) return true;
  fprintf(stderr,
          "tactus: %s: found a trial of seed %" PRIu64 ", expected %d seeds from %" PRIu64
          " on; ask for it too, or write to another file\n",
          options->json, seed, options->trials, options->seed);
  return false;
}

static bool same_pose(const double found[7], const double expected[7]) {
  static const double tolerance = 1e-6; /* results have nine digits */
  for (int i = 0; i < 7; ++i)
    if (!(fabs(found[i] - expected[i]) <= tolerance)) return false;
  return true;
}

static bool complain_of_pose(const trial_options* options, const trial_result* trial, const double expected[7]) {
  fprintf(stderr, "tactus: %s: found a trial of seed %" PRIu64 " with the target at ", options->json, trial->seed);
  json_numbers(stderr, trial->true_pose, 7, json_full);
  fputs(", expected ", stderr);
  json_numbers(stderr, expected, 7, json_full);
  fprintf(stderr, " as %s draws it now; go on with the scenario that the trials are of, or write to another file\n",
          options->scenario);
  return false;
}

static bool is_drawn(const trial_options* options, const tactus_scenario* scenario, const trial_result* trial) {
  double expected[7];
  if (tactus_scenario_sample_pose(scenario, trial->seed, expected) != TACTUS_OK) {
    fprintf(stderr, "tactus: seed %" PRIu64 ": %s\n", trial->seed, tactus_last_error());
    return false;
  }
  return same_pose(trial->true_pose, expected) || complain_of_pose(options, trial, expected);
}

bool trials_belong(const trial_options* options, const tactus_scenario* scenario, const run_result* run) {
  for (int i = 0; i < run->count; ++i) {
    const trial_result* trial = &run->trials[i];
    if (!is_asked_for(options, trial->seed)) return false;
    if (!options->has_true_pose && !is_drawn(options, scenario, trial)) return false;
  }
  return true;
}
