/* SPDX-License-Identifier: BSD-3-Clause */
#include "comparison_json.h"

#include <inttypes.h>
#include <stddef.h>
#include <string.h>

#include "comparison.h"
#include "result_json.h"

#define COUNT(array) (sizeof(array) / sizeof((array)[0]))

static const json_member names[] = {
    {"scenario", member_text, offsetof(run_setting, scenario), sizeof((run_setting*)0)->scenario},
    {"solvers", member_text, offsetof(run_setting, solver), sizeof((run_setting*)0)->solver},
    {"belief", member_text, offsetof(run_setting, belief), sizeof((run_setting*)0)->belief},
    {"phase", member_text, offsetof(run_setting, phase), sizeof((run_setting*)0)->phase},
};

static const json_member of_standing[] = {
    {"finished", member_int, offsetof(standing, finished), 0},
    {"common", member_int, offsetof(standing, common), 0},
    {"cost_m", member_double, offsetof(standing, mean.cost_m), 0},
    {"travel_m", member_double, offsetof(standing, mean.travel_m), 0},
    {"rotation_rad", member_double, offsetof(standing, mean.rotation_rad), 0},
    {"actions", member_double, offsetof(standing, mean.actions), 0},
    {"planner_calls", member_double, offsetof(standing, mean.planner_calls), 0},
    {"planning_s", member_double, offsetof(standing, mean.planning_s), 0},
    {"cost_ratio", member_double, offsetof(standing, cost_ratio), 0},
    {"cost_ratio_low", member_double, offsetof(standing, cost_ratio_low), 0},
    {"cost_ratio_high", member_double, offsetof(standing, cost_ratio_high), 0},
    {"planning_ratio", member_double, offsetof(standing, planning_ratio), 0},
    {"calls_ratio", member_double, offsetof(standing, calls_ratio), 0},
    {"time_per_call_ratio", member_double, offsetof(standing, time_per_call_ratio), 0},
};

/* --- writing */

static void print_standing(FILE* out, const comparison* c, int solver, trial_phase phase) {
  const standing of_phase = compare_to_first(c, solver, phase);
  json_members(out, &of_phase, of_standing, COUNT(of_standing), ", ");
}

static void print_solver(FILE* out, const comparison* c, int solver) {
  const run_result* run = &c->results[solver];
  const run_summary summary = summarise(run);
  fputs("{\"solver\": ", out);
  json_text(out, run->setting.solver);
  fprintf(out, ", \"trials\": %d, \"inserted\": %d", run->count, summary.inserted);
  json_number_field(out, "certificate", summary.certificate, json_full);
  fputs(", ", out);
  print_standing(out, c, solver, phase_whole);
  fputs(",\n     \"phases\": {\"voxels\": {", out);
  print_standing(out, c, solver, phase_voxels);
  fputs("},\n       \"poses\": {", out);
  print_standing(out, c, solver, phase_poses);
  fputs("}}}", out);
}

static void print_one_trial(FILE* out, const char* solver, const trial_result* trial) {
  fputs("{\"solver\": ", out);
  json_text(out, solver);
  fputs(", ", out);
  print_trial(out, trial);
  fprintf(out, ", \"expansions\": %" PRIu64 ", \"ended\": ", trial->expansions);
  print_trial_end(out, trial);
  fputc('}', out);
}

static void print_trials(FILE* out, const comparison* c) {
  const char* between = "\n    ";
  for (int s = 0; s < c->solver_count; ++s)
    for (int i = 0; i < c->results[s].count; ++i, between = ",\n    ") {
      fputs(between, out);
      print_one_trial(out, c->results[s].setting.solver, &c->results[s].trials[i]);
    }
}

static void print_json(FILE* out, const void* results) {
  const comparison* c = results;
  fputs("{\n  ", out);
  json_members(out, &c->setting, names, COUNT(names), ",\n  ");
  fputs(",\n  \"options\": {", out);
  print_options(out, &c->setting);
  fputs("},\n  \"summary\": [", out);
  for (int s = 0; s < c->solver_count; ++s) {
    fputs(s > 0 ? ",\n    " : "\n    ", out);
    print_solver(out, c, s);
  }
  fputs("\n  ],\n  \"trials\": [", out);
  print_trials(out, c);
  fputs("\n  ]\n}\n", out);
}

/* --- reading */

static run_result* result_of(comparison* c, const char* solver) {
  for (int s = 0; s < c->solver_count; ++s)
    if (strcmp(c->results[s].setting.solver, solver) == 0) return &c->results[s];
  return NULL;
}

static bool read_expansions(json_reader* reader, trial_result* trial) {
  return json_expect_key(reader, "expansions") && json_read_whole(reader, &trial->expansions, UINT64_MAX);
}

static bool read_one_trial(json_reader* reader, comparison* c) {
  char solver[solvers_room];
  trial_result trial;
  if (!json_expect(reader, "{") || !json_expect_key(reader, "solver") || !json_read_text(reader, solver, sizeof solver))
    return false;
  run_result* run = result_of(c, solver);
  if (run == NULL) return json_complain(reader, "one of the solvers named above before this");
  return json_expect(reader, ",") && read_trial(reader, &trial) && json_expect(reader, ",") &&
         read_expansions(reader, &trial) && json_expect(reader, ",") && json_expect_key(reader, "ended") &&
         read_trial_end(reader, &trial) && take_trial(reader, &trial, run) && json_expect(reader, "}");
}

static bool read_trials(json_reader* reader, comparison* c) {
  if (!json_expect_key(reader, "trials") || !json_expect(reader, "[")) return false;
  if (json_next(reader, "]")) return true;
  do
    if (!read_one_trial(reader, c)) return false;
  while (json_next(reader, ","));
  return json_expect(reader, "]");
}

static bool read_solvers(json_reader* reader, comparison* c) {
  const run_setting setting = c->setting;
  const char* expected = name_solvers(setting.solver, c);
  return expected == NULL || json_complain(reader, expected);
}

/* The summary follows from the trials. */
static bool read_json(json_reader* reader, void* results) {
  comparison* c = results;
  return json_expect(reader, "{") && json_read_members(reader, &c->setting, names, COUNT(names)) &&
         read_solvers(reader, c) && json_expect(reader, ",") && json_expect_key(reader, "options") &&
         json_expect(reader, "{") && read_options(reader, &c->setting) && json_expect(reader, "}") &&
         json_expect(reader, ",") && json_expect_key(reader, "summary") && json_skip(reader) &&
         json_expect(reader, ",") && read_trials(reader, c) && json_expect(reader, "}");
}

const results_format comparison_format = {print_json, read_json};
