/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "episode.h"
#include "options.h"
#include "result_json.h"
#include "results_file.h"
#include "trials.h"

typedef struct {
  run_options options;
  tactus_scenario* scenario;
  trial_setup setup;
  double* start;
  run_result result;
  FILE* record;
} run;

static bool failed(const char* what) {
  fprintf(stderr, "tactus run: %s\n", what);
  return false;
}

/* --- before the trials */

/* The scenario's options, with those of the command line over them. */
static bool choose_options(run* r) {
  trial_setup* setup = &r->setup;
  const run_options* o = &r->options;
  tactus_belief_options_init(&setup->belief, sizeof setup->belief);
  tactus_planner_options_init(&setup->planner, sizeof setup->planner);
  tactus_world_options_init(&setup->world, sizeof setup->world);
  tactus_costs_init(&setup->costs, sizeof setup->costs);
  tactus_limits_init(&setup->limits, sizeof setup->limits);
  if (tactus_scenario_belief_options(r->scenario, &setup->belief) != TACTUS_OK ||
      tactus_scenario_planner_options(r->scenario, &setup->planner) != TACTUS_OK ||
      tactus_scenario_costs(r->scenario, &setup->costs) != TACTUS_OK ||
      tactus_scenario_limits(r->scenario, &setup->limits) != TACTUS_OK ||
      (o->solver != NULL && tactus_solver_from_name(o->solver, &setup->planner.solver) != TACTUS_OK))
    return failed(tactus_last_error());
  setup->world.stopping_distance = o->stopping_distance;
  setup->world.encoder_error = o->encoder_error;
  setup->world.missed_contacts = o->missed_contacts;
  setup->world.false_contacts = o->false_contacts;
  if (o->belief != NULL)
    setup->belief.kind = strcmp(o->belief, "particles") == 0 ? TACTUS_BELIEF_PARTICLES : TACTUS_BELIEF_HIERARCHICAL;
  if (o->budget_seconds > 0.0 || o->budget_expansions > 0) {
    setup->planner.budget_seconds = o->budget_seconds > 0.0 ? o->budget_seconds : (double)INFINITY;
    setup->planner.budget_expansions = o->budget_expansions;
  }
  return true;
}

static bool load(run* r) {
  trial_setup* setup = &r->setup;
  fprintf(stderr, "loading %s\n", r->options.scenario);
  if (tactus_scenario_load(r->options.scenario, &r->scenario) != TACTUS_OK ||
      tactus_scenario_dof(r->scenario, &setup->dof) != TACTUS_OK)
    return failed(tactus_last_error());
  r->start = malloc(setup->dof * sizeof *r->start);
  if (r->start == NULL) return failed("out of memory");
  if (tactus_scenario_start(r->scenario, r->start, setup->dof, &setup->dof) != TACTUS_OK)
    return failed(tactus_last_error());
  setup->scenario = r->scenario;
  setup->start = r->start;
  return choose_options(r);
}

static double or_nan(bool given, double value) { return given ? value : (double)NAN; }

static run_setting setting_of(const run* r) {
  run_setting setting;
  const run_options* o = &r->options;
  const tactus_planner_options* planner = &r->setup.planner;
  const bool particles = r->setup.belief.kind == TACTUS_BELIEF_PARTICLES;
  const char* name = "";
  tactus_scenario_name(r->scenario, &name);
  snprintf(setting.scenario, sizeof setting.scenario, "%s", name);
  snprintf(setting.solver, sizeof setting.solver, "%s", tactus_solver_name(planner->solver));
  snprintf(setting.belief, sizeof setting.belief, "%s", particles ? "particles" : "hierarchical");
  setting.budget_seconds = or_nan(isfinite(planner->budget_seconds), planner->budget_seconds);
  setting.budget_expansions = planner->budget_expansions;
  for (int i = 0; i < 6; ++i) setting.true_pose[i] = or_nan(o->has_true_pose, o->true_pose[i]);
  setting.stopping_distance = or_nan(o->stopping_distance >= 0.0, o->stopping_distance);
  setting.encoder_error = or_nan(o->encoder_error >= 0.0, o->encoder_error);
  setting.missed_contacts = or_nan(o->missed_contacts >= 0.0, o->missed_contacts);
  setting.false_contacts = or_nan(o->false_contacts >= 0.0, o->false_contacts);
  return setting;
}

static bool open_for_writing(const char* path, FILE** file) {
  *file = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
  if (*file == NULL) fprintf(stderr, "tactus run: %s: found a file that can't be written\n", path);
  return *file != NULL;
}

static bool close_file(FILE* file) {
  if (file == NULL || (file == stdout ? fflush(file) : fclose(file)) == 0) return true;
  return failed("could not write all of the results");
}

/* --- the results */

/* After every trial, and before the first to see that it can be done. */
static bool save_so_far(const run_options* options, const run_result* result) {
  return options->json == NULL || !is_replaceable(options->json) || save_results(options->json, result);
}

/* Into what can't be replaced again and again, such as stdout. */
static bool write_once(const char* path, const run_result* result) {
  FILE* out = NULL;
  if (!open_for_writing(path, &out)) return false;
  print_json(out, result);
  return close_file(out);
}

static bool to_stdout(const char* path) { return path != NULL && strcmp(path, "-") == 0; }

static int report(const run* r) {
  const run_options* o = &r->options;
  print_table(to_stdout(o->json) || to_stdout(o->record) ? stderr : stdout, &r->result);
  if (o->json != NULL && !is_replaceable(o->json) && !write_once(o->json, &r->result)) return exit_usage;
  return summarise(&r->result).inserted == r->result.count ? exit_good : exit_not_inserted;
}

/* --- the run */

static int run_all(run* r) {
  const run_options* o = &r->options;
  if ((o->resume && !load_results(o->json, &r->result)) || !load(r)) return exit_usage;
  const run_setting setting = setting_of(r);
  if (!trials_belong(o->json, &r->result, &setting, o->seed, o->trials)) return exit_usage;
  r->result.setting = setting;
  if (o->resume) fprintf(stderr, "%s: %d of %d trials are there\n", o->json, r->result.count, o->trials);
  if ((o->record != NULL && !open_for_writing(o->record, &r->record)) || !save_so_far(o, &r->result) ||
      !run_trials(&r->setup, o, r->record, save_so_far, &r->result))
    return exit_usage;
  return report(r);
}

int run_command(int argc, char** argv) {
  run r;
  memset(&r, 0, sizeof r);
  if (!parse_run_options(argc, argv, &r.options)) return exit_usage;
  int result = run_all(&r);
  if (!close_file(r.record)) result = exit_usage;
  free(r.start);
  free(r.result.trials);
  tactus_scenario_destroy(r.scenario);
  return result;
}
