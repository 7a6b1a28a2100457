/* SPDX-License-Identifier: BSD-3-Clause */
#include <string.h>

#include "commands.h"
#include "comparison.h"
#include "comparison_json.h"
#include "resume.h"
#include "setup.h"
#include "tables.h"
#include "trials.h"

typedef struct {
  trial_options options;
  loaded_setup setup;
  trial_setup setups[most_solvers]; /* one a solver */
  comparison comparison;
} compare;

static bool complain(const char* option, const char* found, const char* expected) {
  fprintf(stderr, "tactus compare: %s: found '%s', expected %s\n", option, found, expected);
  return false;
}

/* --- before the trials */

static bool name_all(compare* c) {
  const char* solvers = c->options.solvers != NULL ? c->options.solvers : "";
  const char* expected = name_solvers(solvers, &c->comparison);
  return expected == NULL || complain("--solvers", solvers, expected);
}

/* A planner is made at once, to hear of a solver that there is not before any trial. */
static bool set_up_solver(const trial_setup* common, const char* name, trial_setup* setup) {
  tactus_planner* planner = NULL;
  *setup = *common;
  const bool good = tactus_solver_from_name(name, &setup->planner.solver) == TACTUS_OK &&
                    tactus_planner_create(setup->scenario, &setup->planner, &planner) == TACTUS_OK;
  tactus_planner_destroy(planner);
  if (!good) fprintf(stderr, "tactus compare: --solvers: %s: %s\n", name, tactus_last_error());
  return good;
}

static bool set_up(compare* c) {
  if (!load_setup(&c->options, &c->setup)) return false;
  if (c->options.phase != phase_whole && c->setup.trial.belief.kind == TACTUS_BELIEF_PARTICLES)
    return complain("--phase", trial_phase_name(c->options.phase),
                    "whole: a belief of particles has no voxels; for phases ask for --belief hierarchical");
  for (int s = 0; s < c->comparison.solver_count; ++s)
    if (!set_up_solver(&c->setup.trial, c->comparison.results[s].setting.solver, &c->setups[s])) return false;
  return true;
}

/* --- the results */

static int count_trials(const comparison* c) {
  int count = 0;
  for (int s = 0; s < c->solver_count; ++s) count += c->results[s].count;
  return count;
}

static bool asks_for_all(compare* c, const comparison* found) {
  for (int s = 0; s < found->solver_count; ++s)
    if (find_solver(&c->comparison, found->results[s].setting.solver) == NULL) return false;
  return true;
}

/* In the phase of poses another first solver leads elsewhere, and one more finds no belief to begin with. */
static bool has_led(const compare* c, const run_setting* found) {
  const char* phase = trial_phase_name(phase_poses);
  if (c->options.phase != phase_poses || strcmp(found->phase, phase) != 0) return true;
  if (strcmp(found->solver, c->options.solvers) == 0) return true;
  fprintf(stderr,
          "tactus: %s: found trials with solver \"%s\", expected \"%s\" as asked for now; with --phase poses trials "
          "begin with beliefs that were not kept: ask for the same solvers in the same order, or write to another "
          "file\n",
          c->options.json, found->solver, c->options.solvers);
  return false;
}

/* More solvers may be asked for than the file has. */
static bool belongs(compare* c, const comparison* found, const run_setting* setting) {
  const trial_options* o = &c->options;
  run_setting expected = *setting;
  if (!has_led(c, &found->setting)) return false;
  if (asks_for_all(c, found)) memcpy(expected.solver, found->setting.solver, sizeof expected.solver);
  if (!settings_agree(o, &found->setting, &expected)) return false;
  for (int s = 0; s < found->solver_count; ++s)
    if (!trials_belong(o, c->setup.scenario, &found->results[s])) return false;
  return true;
}

static void move_in(compare* c, comparison* found) {
  for (int s = 0; s < found->solver_count; ++s) {
    run_result* run = &found->results[s];
    run_result* place = find_solver(&c->comparison, run->setting.solver);
    place->trials = run->trials;
    place->count = run->count;
    place->room = run->room;
  }
}

/* The trials that the file has, if they are of this comparison. */
static bool take_over(compare* c, const run_setting* setting) {
  const trial_options* o = &c->options;
  comparison found;
  memset(&found, 0, sizeof found);
  const results_file file = {o->json, &comparison_format, &found};
  if (!load_results(&file) || (count_trials(&found) > 0 && !belongs(c, &found, setting))) {
    free_comparison(&found);
    return false;
  }
  if (count_trials(&found) > 0)
    move_in(c, &found);
  else
    free_comparison(&found);
  if (o->phase == phase_poses) forget_half_done(&c->comparison); /* their beliefs were not kept */
  fprintf(stderr, "%s: %d of %d trials are there\n", o->json, count_trials(&c->comparison),
          c->comparison.solver_count * o->trials);
  return true;
}

static int report(const compare* c, const results_file* file) {
  print_comparison(is_stdout(file->path) ? stderr : stdout, &c->comparison);
  if (!write_at_end(file)) return exit_usage;
  return all_finished(&c->comparison) ? exit_good : exit_not_inserted;
}

static int run_all(compare* c) {
  const trial_options* o = &c->options;
  const results_file file = {o->json, &comparison_format, &c->comparison};
  if (!name_all(c) || !set_up(c)) return exit_usage;
  const run_setting setting = setting_of(o, &c->setup);
  if (o->resume && !take_over(c, &setting)) return exit_usage;
  c->comparison.setting = setting;
  const campaign all = {o, c->setups, c->comparison.results, c->comparison.solver_count, NULL, &file};
  if (!save_results(&file)) return exit_usage;
  const bool ran = run_trials(&all), kept = save_tables(o->tables, c->setup.scenario);
  const int reported = report(c, &file);
  return ran && kept ? reported : exit_usage;
}

int compare_command(int argc, char** argv) {
  compare c;
  memset(&c, 0, sizeof c);
  const int result = parse_options("compare", argc, argv, &c.options) ? run_all(&c) : exit_usage;
  free_comparison(&c.comparison);
  free_setup(&c.setup);
  return result;
}
