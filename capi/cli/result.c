/* SPDX-License-Identifier: BSD-3-Clause */
#include "result.h"

#include <inttypes.h>
#include <string.h>

#include "json.h"

run_summary summarise(const run_result* run) {
  run_summary sum;
  memset(&sum, 0, sizeof sum);
  for (int i = 0; i < run->count; ++i) {
    const trial_result* trial = &run->trials[i];
    const double share = 1.0 / run->count;
    sum.inserted += trial->inserted;
    sum.truth_kept += trial->truth_kept;
    sum.cost_m += share * trial->cost_m;
    sum.travel_m += share * trial->travel_m;
    sum.rotation_rad += share * trial->rotation_rad;
    sum.actions += share * trial->actions;
    sum.contacts += share * trial->contacts;
    sum.planner_calls += share * (double)trial->planner_calls;
    sum.planning_s += share * trial->planning_s;
    sum.expansions += share * (double)trial->expansions;
  }
  return sum;
}

static void print_trial(FILE* out, const trial_result* trial) {
  fprintf(out, "    {\"seed\": %" PRIu64, trial->seed);
  json_numbers_field(out, "true_pose", trial->true_pose, 7, json_full);
  json_bool_field(out, "inserted", trial->inserted);
  json_bool_field(out, "truth_kept", trial->truth_kept);
  json_number_field(out, "cost_m", trial->cost_m, json_full);
  json_number_field(out, "travel_m", trial->travel_m, json_full);
  json_number_field(out, "rotation_rad", trial->rotation_rad, json_full);
  json_number_field(out, "actions", trial->actions, json_full);
  json_number_field(out, "contacts", trial->contacts, json_full);
  json_number_field(out, "planner_calls", (double)trial->planner_calls, json_full);
  json_number_field(out, "planning_s", trial->planning_s, json_full);
  json_number_field(out, "phase1_cost_m", trial->phase1_cost_m, json_full);
  json_number_field(out, "position_error_m", trial->position_error_m, json_full);
  json_number_field(out, "angle_error_rad", trial->angle_error_rad, json_full);
  fputc('}', out);
}

static void print_summary(FILE* out, const run_result* run) {
  const run_summary mean = summarise(run);
  fprintf(out, "  \"summary\": {\"trials\": %d, \"inserted\": %d, \"truth_kept\": %d", run->count, mean.inserted,
          mean.truth_kept);
  json_number_field(out, "mean_cost_m", mean.cost_m, json_full);
  json_number_field(out, "mean_travel_m", mean.travel_m, json_full);
  json_number_field(out, "mean_rotation_rad", mean.rotation_rad, json_full);
  json_number_field(out, "mean_actions", mean.actions, json_full);
  json_number_field(out, "mean_contacts", mean.contacts, json_full);
  json_number_field(out, "mean_planner_calls", mean.planner_calls, json_full);
  json_number_field(out, "mean_planning_s", mean.planning_s, json_full);
  json_number_field(out, "mean_expansions", mean.expansions, json_full);
  fputs("}\n", out);
}

void print_json(FILE* out, const run_result* run) {
  fputs("{\n  \"scenario\": ", out);
  json_text(out, run->scenario);
  fputs(",\n  \"solver\": ", out);
  json_text(out, run->solver);
  fputs(",\n  \"belief\": ", out);
  json_text(out, run->belief);
  fputs(",\n  \"trials\": [\n", out);
  for (int i = 0; i < run->count; ++i) {
    print_trial(out, &run->trials[i]);
    fputs(i + 1 < run->count ? ",\n" : "\n", out);
  }
  fputs("  ],\n", out);
  print_summary(out, run);
  fputs("}\n", out);
}
