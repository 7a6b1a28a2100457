/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "episode.h"
#include "options.h"

typedef struct {
  run_options options;
  tactus_scenario* scenario;
  trial_setup setup;
  double* start;
  trial_result* trials;
  FILE *json, *record;
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
  r->trials = calloc((size_t)r->options.trials, sizeof *r->trials);
  if (r->start == NULL || r->trials == NULL) return failed("out of memory");
  if (tactus_scenario_start(r->scenario, r->start, setup->dof, &setup->dof) != TACTUS_OK)
    return failed(tactus_last_error());
  setup->scenario = r->scenario;
  setup->start = r->start;
  return choose_options(r);
}

static bool open_for_writing(const char* path, FILE** file) {
  if (path == NULL) return true;
  *file = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
  if (*file == NULL) fprintf(stderr, "tactus run: %s: found a file that can't be written\n", path);
  return *file != NULL;
}

/* --- the trials */

static bool run_one(run* r, int i) {
  const run_options* o = &r->options;
  const uint64_t seed = o->seed + (uint64_t)i;
  double pose[7];
  const tactus_status status = o->has_true_pose ? tactus_pose_from_rpy(o->true_pose, pose)
                                                : tactus_scenario_sample_pose(r->scenario, seed, pose);
  if (status != TACTUS_OK) return failed(tactus_last_error());
  return run_trial(&r->setup, seed, pose, i == 0 ? r->record : NULL, &r->trials[i]);
}

static run_result result_of(const run* r) {
  run_result result = {"", tactus_solver_name(r->setup.planner.solver), "", r->trials, r->options.trials};
  tactus_scenario_name(r->scenario, &result.scenario);
  result.belief = r->setup.belief.kind == TACTUS_BELIEF_PARTICLES ? "particles" : "hierarchical";
  return result;
}

static int report(run* r) {
  const run_result result = result_of(r);
  print_table(r->json == stdout || r->record == stdout ? stderr : stdout, &result);
  if (r->json != NULL) print_json(r->json, &result);
  return summarise(&result).inserted == result.count ? exit_good : exit_not_inserted;
}

static int run_all(run* r) {
  if (!load(r) || !open_for_writing(r->options.json, &r->json) || !open_for_writing(r->options.record, &r->record))
    return exit_usage;
  for (int i = 0; i < r->options.trials; ++i)
    if (!run_one(r, i)) return exit_usage;
  return report(r);
}

static bool close_file(FILE* file) { return file == NULL || (file == stdout ? fflush(file) : fclose(file)) == 0; }

int run_command(int argc, char** argv) {
  run r;
  memset(&r, 0, sizeof r);
  if (!parse_run_options(argc, argv, &r.options)) return exit_usage;
  int result = run_all(&r);
  const bool written = close_file(r.json), recorded = close_file(r.record);
  if (!written || !recorded) {
    failed("could not write all of the results");
    result = exit_usage;
  }
  free(r.start);
  free(r.trials);
  tactus_scenario_destroy(r.scenario);
  return result;
}
