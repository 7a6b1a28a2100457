/* SPDX-License-Identifier: BSD-3-Clause */
#include "setup.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tables.h"

static bool failed(const char* what) {
  fprintf(stderr, "tactus: %s\n", what);
  return false;
}

/* The scenario's options, with those of the command line over them. */
static bool choose_options(const trial_options* o, trial_setup* setup) {
  tactus_belief_options_init(&setup->belief, sizeof setup->belief);
  tactus_planner_options_init(&setup->planner, sizeof setup->planner);
  tactus_world_options_init(&setup->world, sizeof setup->world);
  tactus_costs_init(&setup->costs, sizeof setup->costs);
  tactus_limits_init(&setup->limits, sizeof setup->limits);
  if (tactus_scenario_belief_options(setup->scenario, &setup->belief) != TACTUS_OK ||
      tactus_scenario_planner_options(setup->scenario, &setup->planner) != TACTUS_OK ||
      tactus_scenario_costs(setup->scenario, &setup->costs) != TACTUS_OK ||
      tactus_scenario_limits(setup->scenario, &setup->limits) != TACTUS_OK ||
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

bool load_setup(const trial_options* options, loaded_setup* setup) {
  trial_setup* trial = &setup->trial;
  fprintf(stderr, "loading %s\n", options->scenario);
  if (tactus_scenario_load(options->scenario, &setup->scenario) != TACTUS_OK ||
      tactus_scenario_dof(setup->scenario, &trial->dof) != TACTUS_OK)
    return failed(tactus_last_error());
  if (!load_tables(options->tables, setup->scenario)) return false;
  setup->start = malloc(trial->dof * sizeof *setup->start);
  if (setup->start == NULL) return failed("out of memory");
  if (tactus_scenario_start(setup->scenario, setup->start, trial->dof, &trial->dof) != TACTUS_OK)
    return failed(tactus_last_error());
  trial->scenario = setup->scenario;
  trial->start = setup->start;
  return choose_options(options, trial);
}

void free_setup(loaded_setup* setup) {
  free(setup->start);
  tactus_scenario_destroy(setup->scenario);
}

static void set_terms(const trial_setup* trial, run_setting* setting) {
  setting->has_terms = true;
  setting->cost_metre = trial->costs.metre;
  setting->cost_radian = trial->costs.radian;
  setting->cost_action = trial->costs.action;
  setting->limit_actions = trial->limits.actions;
  setting->limit_travel = trial->limits.travel;
  setting->limit_seconds = trial->limits.seconds;
}

static double or_nan(bool given, double value) { return given ? value : (double)NAN; }

run_setting setting_of(const trial_options* options, const loaded_setup* setup) {
  run_setting setting;
  const tactus_planner_options* planner = &setup->trial.planner;
  const bool particles = setup->trial.belief.kind == TACTUS_BELIEF_PARTICLES;
  const char* solver = options->solvers != NULL ? options->solvers : tactus_solver_name(planner->solver);
  const char* name = "";
  tactus_scenario_name(setup->scenario, &name);
  snprintf(setting.scenario, sizeof setting.scenario, "%s", name);
  snprintf(setting.solver, sizeof setting.solver, "%s", solver);
  snprintf(setting.belief, sizeof setting.belief, "%s", particles ? "particles" : "hierarchical");
  snprintf(setting.phase, sizeof setting.phase, "%s", trial_phase_name(options->phase));
  setting.budget_seconds = or_nan(isfinite(planner->budget_seconds), planner->budget_seconds);
  setting.budget_expansions = planner->budget_expansions;
  for (int i = 0; i < 6; ++i) setting.true_pose[i] = or_nan(options->has_true_pose, options->true_pose[i]);
  setting.stopping_distance = or_nan(options->stopping_distance >= 0.0, options->stopping_distance);
  setting.encoder_error = or_nan(options->encoder_error >= 0.0, options->encoder_error);
  setting.missed_contacts = or_nan(options->missed_contacts >= 0.0, options->missed_contacts);
  setting.false_contacts = or_nan(options->false_contacts >= 0.0, options->false_contacts);
  set_terms(&setup->trial, &setting);
  return setting;
}
