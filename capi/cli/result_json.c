/* SPDX-License-Identifier: BSD-3-Clause */
#include "result_json.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const json_member names[] = {
    {"scenario", member_text, offsetof(run_setting, scenario), sizeof((run_setting*)0)->scenario},
    {"solver", member_text, offsetof(run_setting, solver), sizeof((run_setting*)0)->solver},
    {"belief", member_text, offsetof(run_setting, belief), sizeof((run_setting*)0)->belief},
};

static const json_member phase[] = {
    {"phase", member_text, offsetof(run_setting, phase), sizeof((run_setting*)0)->phase},
};

static const json_member options[] = {
    {"budget_seconds", member_double, offsetof(run_setting, budget_seconds), 0},
    {"budget_expansions", member_whole, offsetof(run_setting, budget_expansions), 0},
    {"true_pose", member_doubles, offsetof(run_setting, true_pose), 6},
    {"stopping_distance", member_double, offsetof(run_setting, stopping_distance), 0},
    {"encoder_error", member_double, offsetof(run_setting, encoder_error), 0},
    {"missed_contacts", member_double, offsetof(run_setting, missed_contacts), 0},
    {"false_contacts", member_double, offsetof(run_setting, false_contacts), 0},
};

static const json_member terms[] = {
    {"cost_metre", member_double, offsetof(run_setting, cost_metre), 0},
    {"cost_radian", member_double, offsetof(run_setting, cost_radian), 0},
    {"cost_action", member_double, offsetof(run_setting, cost_action), 0},
    {"limit_actions", member_int, offsetof(run_setting, limit_actions), 0},
    {"limit_travel", member_double, offsetof(run_setting, limit_travel), 0},
    {"limit_seconds", member_double, offsetof(run_setting, limit_seconds), 0},
};

static const json_member of_trial[] = {
    {"seed", member_whole, offsetof(trial_result, seed), 0},
    {"true_pose", member_doubles, offsetof(trial_result, true_pose), 7},
    {"inserted", member_bool, offsetof(trial_result, inserted), 0},
    {"truth_kept", member_bool, offsetof(trial_result, truth_kept), 0},
    {"cost_m", member_double, offsetof(trial_result, whole.cost_m), 0},
    {"travel_m", member_double, offsetof(trial_result, whole.travel_m), 0},
    {"rotation_rad", member_double, offsetof(trial_result, whole.rotation_rad), 0},
    {"actions", member_count, offsetof(trial_result, whole.actions), 0},
    {"contacts", member_int, offsetof(trial_result, contacts), 0},
    {"planner_calls", member_count, offsetof(trial_result, whole.planner_calls), 0},
    {"planning_s", member_double, offsetof(trial_result, whole.planning_s), 0},
    {"phase1_cost_m", member_double, offsetof(trial_result, voxels.cost_m), 0},
    {"position_error_m", member_double, offsetof(trial_result, position_error_m), 0},
    {"angle_error_rad", member_double, offsetof(trial_result, angle_error_rad), 0},
    {"phase1_travel_m", member_double, offsetof(trial_result, voxels.travel_m), 0},
    {"phase1_rotation_rad", member_double, offsetof(trial_result, voxels.rotation_rad), 0},
    {"phase1_actions", member_count, offsetof(trial_result, voxels.actions), 0},
    {"phase1_planner_calls", member_count, offsetof(trial_result, voxels.planner_calls), 0},
    {"phase1_planning_s", member_double, offsetof(trial_result, voxels.planning_s), 0},
    {"slowest_planning_s", member_double, offsetof(trial_result, slowest_planning_s), 0},
    {"late_plans", member_int, offsetof(trial_result, late_plans), 0},
    {"stepping_s", member_double, offsetof(trial_result, stepping_s), 0},
    {"slowest_step_s", member_double, offsetof(trial_result, slowest_step_s), 0},
    {"poses_lower_bound", member_double, offsetof(trial_result, poses_lower_bound), 0},
    {"poses_value", member_double, offsetof(trial_result, poses_value), 0},
};

static const json_member of_summary[] = {
    {"trials", member_int, offsetof(run_summary, trials), 0},
    {"inserted", member_int, offsetof(run_summary, inserted), 0},
    {"truth_kept", member_int, offsetof(run_summary, truth_kept), 0},
    {"mean_cost_m", member_double, offsetof(run_summary, mean.cost_m), 0},
    {"mean_travel_m", member_double, offsetof(run_summary, mean.travel_m), 0},
    {"mean_rotation_rad", member_double, offsetof(run_summary, mean.rotation_rad), 0},
    {"mean_actions", member_double, offsetof(run_summary, mean.actions), 0},
    {"mean_contacts", member_double, offsetof(run_summary, contacts), 0},
    {"mean_planner_calls", member_double, offsetof(run_summary, mean.planner_calls), 0},
    {"mean_planning_s", member_double, offsetof(run_summary, mean.planning_s), 0},
    {"mean_expansions", member_double, offsetof(run_summary, expansions), 0},
    {"slowest_planning_s", member_double, offsetof(run_summary, slowest_planning_s), 0},
    {"late_plans", member_int, offsetof(run_summary, late_plans), 0},
    {"mean_stepping_s", member_double, offsetof(run_summary, stepping_s), 0},
    {"slowest_step_s", member_double, offsetof(run_summary, slowest_step_s), 0},
    {"certificate", member_double, offsetof(run_summary, certificate), 0},
};

/* --- writing */

void print_trial(FILE* out, const trial_result* trial) { json_members(out, trial, of_trial, COUNT(of_trial), ", "); }

void print_trial_end(FILE* out, const trial_result* trial) { json_text(out, trial_end_name(trial->ended)); }

void print_options(FILE* out, const run_setting* setting) {
  json_members(out, setting, options, COUNT(options), ", ");
  fputs(", ", out);
  json_members(out, setting, terms, COUNT(terms), ", ");
}

static void print_trials(FILE* out, const run_result* run) {
  fputs("  \"trials\": [", out);
  for (int i = 0; i < run->count; ++i) {
    fputs(i > 0 ? ",\n    {" : "\n    {", out);
    print_trial(out, &run->trials[i]);
    fputc('}', out);
  }
  fputs("\n  ],\n", out);
}

/* Beside the figures all that it takes to go on with the run. */
static void print_summary(FILE* out, const run_result* run) {
  const run_summary summary = summarise(run);
  fputs("  \"summary\": {", out);
  json_members(out, &summary, of_summary, COUNT(of_summary), ", ");
  fputs(",\n    \"options\": {", out);
  print_options(out, &run->setting);
  fputs("},\n    \"expansions\": [", out);
  for (int i = 0; i < run->count; ++i) fprintf(out, "%s%" PRIu64, i > 0 ? ", " : "", run->trials[i].expansions);
  fputs("],\n    \"ended\": [", out);
  for (int i = 0; i < run->count; ++i) {
    if (i > 0) fputs(", ", out);
    print_trial_end(out, &run->trials[i]);
  }
  fputs("]}\n", out);
}

static void print_run(FILE* out, const void* results) {
  const run_result* run = results;
  fputs("{\n  ", out);
  json_members(out, &run->setting, names, COUNT(names), ",\n  ");
  fputs(",\n", out);
  print_trials(out, run);
  print_summary(out, run);
  fputs("}\n", out);
}

/* --- reading */

bool read_trial(json_reader* reader, trial_result* trial) {
  memset(trial, 0, sizeof *trial);
  return json_read_members(reader, trial, of_trial, COUNT(of_trial));
}

bool read_trial_end(json_reader* reader, trial_result* trial) {
  char name[32];
  if (!json_read_text(reader, name, sizeof name)) return false;
  for (trial->ended = trial_at_goal; trial->ended < trial_end_count; ++trial->ended)
    if (strcmp(name, trial_end_name(trial->ended)) == 0) return true;
  return json_complain(reader, "a way in which a trial ends before this");
}

bool read_options(json_reader* reader, run_setting* setting) {
  if (!json_read_members(reader, setting, options, COUNT(options))) return false;
  setting->has_terms = json_next(reader, ",");
  return !setting->has_terms || json_read_members(reader, setting, terms, COUNT(terms));
}

bool take_trial(json_reader* reader, const trial_result* trial, run_result* run) {
  if (run->count > 0 && trial->seed <= run->trials[run->count - 1].seed)
    return json_complain(reader, "trials in the order of their seeds, each once");
  return add_trial(run, trial) || json_complain(reader, "room for one more trial");
}

static bool read_one_trial(json_reader* reader, run_result* run) {
  trial_result trial;
  return json_expect(reader, "{") && read_trial(reader, &trial) && take_trial(reader, &trial, run) &&
         json_expect(reader, "}");
}

static bool read_trials(json_reader* reader, run_result* run) {
  if (!json_expect_key(reader, "trials") || !json_expect(reader, "[")) return false;
  if (json_next(reader, "]")) return true;
  do
    if (!read_one_trial(reader, run)) return false;
  while (json_next(reader, ","));
  return json_expect(reader, "]");
}

static bool read_expansions(json_reader* reader, trial_result* trial) {
  return json_read_whole(reader, &trial->expansions, UINT64_MAX);
}

/* An array of one value a trial. */
static bool read_for_each(json_reader* reader, const char* key, bool (*read)(json_reader*, trial_result*),
                          run_result* run) {
  if (!json_expect(reader, ",") || !json_expect_key(reader, key) || !json_expect(reader, "[")) return false;
  for (int i = 0; i < run->count; ++i)
    if ((i > 0 && !json_expect(reader, ",")) || !read(reader, &run->trials[i])) return false;
  return json_expect(reader, "]");
}

static bool read_summary(json_reader* reader, run_result* run) {
  run_summary summary;
  return json_expect_key(reader, "summary") && json_expect(reader, "{") &&
         json_read_members(reader, &summary, of_summary, COUNT(of_summary)) && json_expect(reader, ",") &&
         json_expect_key(reader, "options") && json_expect(reader, "{") && read_options(reader, &run->setting) &&
         json_expect(reader, "}") && read_for_each(reader, "expansions", read_expansions, run) &&
         read_for_each(reader, "ended", read_trial_end, run) && json_expect(reader, "}");
}

static bool read_run(json_reader* reader, void* results) {
  run_result* run = results;
  snprintf(run->setting.phase, sizeof run->setting.phase, "%s", trial_phase_name(phase_whole));
  return json_expect(reader, "{") && json_read_members(reader, &run->setting, names, COUNT(names)) &&
         json_expect(reader, ",") && read_trials(reader, run) && json_expect(reader, ",") &&
         read_summary(reader, run) && json_expect(reader, "}");
}

const results_format run_format = {print_run, read_run};

/* --- comparing */

/* The value as the JSON has it: two numbers that differ in the tenth digit only are the same. */
static void value_text(const run_setting* setting, const json_member* member, char* text, size_t room) {
  memset(text, 0, room);
  FILE* out = fmemopen(text, room, "w");
  if (out == NULL) return;
  json_member_value(out, setting, member);
  fclose(out);
}

static bool same_members(const run_setting* found, const run_setting* expected, const json_member* members,
                         size_t count, setting_difference* difference) {
  for (size_t i = 0; i < count; ++i) {
    value_text(found, &members[i], difference->found, sizeof difference->found);
    value_text(expected, &members[i], difference->expected, sizeof difference->expected);
    if (strcmp(difference->found, difference->expected) == 0) continue;
    snprintf(difference->name, sizeof difference->name, "%s", members[i].key);
    for (char* c = difference->name; *c != '\0'; ++c)
      if (*c == '_') *c = '-';
    return false;
  }
  return true;
}

bool same_setting(const run_setting* found, const run_setting* expected, setting_difference* difference) {
  difference->said_by = "asked for";
  if (!same_members(found, expected, names, COUNT(names), difference) ||
      !same_members(found, expected, phase, COUNT(phase), difference) ||
      !same_members(found, expected, options, COUNT(options), difference))
    return false;
  difference->said_by = "the scenario has it";
  return !found->has_terms || same_members(found, expected, terms, COUNT(terms), difference);
}
