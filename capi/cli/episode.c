/* SPDX-License-Identifier: BSD-3-Clause */
#include "episode.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "record.h"

typedef struct {
  const trial_setup* setup;
  trial_result* result;
  tactus_world* world;
  tactus_belief* belief;
  tactus_planner* planner;
  tactus_observation observation; /* of the last action */
  tactus_summary summary;         /* of the belief as it is */
  tactus_statistics statistics;   /* of the last query */
  recording* record;              /* may be NULL */
  time_t began;
} episode;

/* --- what is measured */

static tactus_status measure(episode* e) {
  trial_result* r = e->result;
  const tactus_costs* costs = &e->setup->costs;
  tactus_status status = tactus_world_travelled(e->world, &r->travel_m, &r->rotation_rad);
  if (status == TACTUS_OK) status = tactus_belief_summary(e->belief, &e->summary);
  if (status == TACTUS_OK) status = tactus_planner_statistics(e->planner, &e->statistics);
  r->cost_m = costs->metre * r->travel_m + costs->radian * r->rotation_rad + costs->action * r->actions;
  r->planner_calls = e->statistics.total_calls;
  r->planning_s = e->statistics.total_seconds;
  r->expansions = e->statistics.total_expansions;
  const bool poses = e->summary.phase == TACTUS_PHASE_POSES;
  if (poses && isnan(r->phase1_cost_m) && e->setup->belief.kind == TACTUS_BELIEF_HIERARCHICAL)
    r->phase1_cost_m = r->cost_m;
  return status;
}

/* The belief's mean against the truth, and whether the plug is in. */
static tactus_status measure_end(episode* e) {
  trial_result* r = e->result;
  double mean[7];
  int32_t inserted = 0;
  tactus_status status = tactus_pose_from_rpy(e->summary.mean, mean);
  if (status == TACTUS_OK) status = tactus_world_inserted(e->world, &inserted);
  if (status != TACTUS_OK) return status;
  const double* truth = r->true_pose;
  double squares = 0.0, cosine = 0.0;
  for (int i = 0; i < 3; ++i) squares += (mean[i] - truth[i]) * (mean[i] - truth[i]);
  for (int i = 3; i < 7; ++i) cosine += mean[i] * truth[i];
  r->position_error_m = sqrt(squares);
  r->angle_error_rad = 2.0 * acos(fmin(1.0, fabs(cosine)));
  r->inserted = inserted != 0;
  return TACTUS_OK;
}

/* --- the loop */

static void print_progress(const episode* e, const char* kind) {
  const trial_result* r = e->result;
  const bool voxels = e->summary.phase == TACTUS_PHASE_VOXELS;
  fprintf(stderr, "seed %-4" PRIu64 " %3d  %-9s  %-10s  %s %6" PRIu64 "  %5.1f bits  cost %7.3f  planning %6.2f s%s\n",
          r->seed, r->actions, kind, e->observation.contact ? "contact" : "no contact", voxels ? "voxels" : "cells ",
          voxels ? e->summary.possibly_occupied : e->summary.cells, e->summary.bits, r->cost_m, r->planning_s,
          e->summary.health == TACTUS_HEALTH_GOOD ? "" : "  contradicted");
}

/* Executes an action, and takes in what is seen. */
static tactus_status perform(episode* e, const tactus_action* action) {
  trial_result* r = e->result;
  tactus_action_properties properties;
  int32_t kept = 0;
  tactus_action_properties_init(&properties, sizeof properties);
  tactus_status status = tactus_action_info(action, &properties);
  if (status == TACTUS_OK) status = tactus_world_execute(e->world, action, &e->observation);
  if (status == TACTUS_OK) status = tactus_belief_step(e->belief, action, &e->observation);
  if (status == TACTUS_OK) status = tactus_belief_contains(e->belief, r->true_pose, &kept);
  if (status != TACTUS_OK) return status;
  r->actions += 1;
  r->contacts += e->observation.contact;
  r->truth_kept = r->truth_kept && kept != 0;
  status = measure(e);
  if (status != TACTUS_OK) return status;
  const char* kind = tactus_action_kind_name(properties.kind);
  print_progress(e, kind);
  const step_facts facts = {kind, r->cost_m, r->planning_s};
  if (e->record != NULL && !record_step(e->record, action, &e->observation, e->belief, &facts)) return TACTUS_INTERNAL;
  return TACTUS_OK;
}

static trial_end limit_reached(const episode* e) {
  const tactus_limits* limits = &e->setup->limits;
  if (e->result->actions >= limits->actions) return trial_at_limit_of_actions;
  if (e->result->travel_m >= limits->travel) return trial_at_limit_of_travel;
  if (difftime(time(NULL), e->began) >= limits->seconds) return trial_at_limit_of_time;
  return trial_goes_on;
}

static trial_end ending(const episode* e, tactus_status status) {
  if (status == TACTUS_GOAL_REACHED) return trial_at_goal;
  if (status == TACTUS_NO_INFORMATIVE_ACTION) return trial_out_of_actions;
  if (status == TACTUS_CANCELLED) return trial_cancelled;
  fprintf(stderr, "tactus run: seed %" PRIu64 ": %s: %s\n", e->result->seed, tactus_status_name(status),
          tactus_last_error());
  return trial_failed;
}

static void loop(episode* e) {
  for (;;) {
    tactus_action* action = NULL;
    tactus_status status = tactus_planner_query_action(e->planner, e->belief, &action);
    if (status == TACTUS_OK) status = perform(e, action);
    tactus_action_destroy(action);
    e->result->ended = status == TACTUS_OK ? limit_reached(e) : ending(e, status);
    if (e->result->ended != trial_goes_on) break;
  }
  if (measure(e) != TACTUS_OK || measure_end(e) != TACTUS_OK) e->result->ended = ending(e, TACTUS_INTERNAL);
}

/* --- a trial */

static tactus_status begin(episode* e, uint64_t seed) {
  const trial_setup* setup = e->setup;
  tactus_planner_options planner = setup->planner;
  tactus_world_options world = setup->world;
  planner.seed = world.seed = seed;
  tactus_summary_init(&e->summary, sizeof e->summary);
  tactus_statistics_init(&e->statistics, sizeof e->statistics);
  tactus_observation_init(&e->observation, sizeof e->observation);
  tactus_status status = tactus_world_create(setup->scenario, e->result->true_pose, &world, &e->world);
  if (status == TACTUS_OK) status = tactus_belief_create(setup->scenario, &setup->belief, setup->start, &e->belief);
  if (status == TACTUS_OK) status = tactus_planner_create(setup->scenario, &planner, &e->planner);
  return status;
}

static void init_result(trial_result* result, uint64_t seed, const double true_pose[7]) {
  memset(result, 0, sizeof *result);
  memcpy(result->true_pose, true_pose, sizeof result->true_pose);
  result->seed = seed;
  result->truth_kept = true;
  result->phase1_cost_m = result->position_error_m = result->angle_error_rad = NAN;
}

bool run_trial(const trial_setup* setup, uint64_t seed, const double true_pose[7], FILE* record, trial_result* result) {
  episode e;
  memset(&e, 0, sizeof e);
  init_result(result, seed, true_pose);
  e.setup = setup;
  e.result = result;
  e.began = time(NULL);
  double* joints = malloc(setup->dof * sizeof *joints);
  bool good = joints != NULL && begin(&e, seed) == TACTUS_OK;
  if (good && record != NULL) good = (e.record = record_begin(record, setup->scenario, e.belief, true_pose)) != NULL;
  if (good) {
    e.observation.joints = joints;
    e.observation.joint_count = setup->dof;
    loop(&e);
  } else {
    fprintf(stderr, "tactus run: seed %" PRIu64 ": %s\n", seed, tactus_last_error());
  }
  record_end(e.record, result->inserted);
  tactus_planner_destroy(e.planner);
  tactus_belief_destroy(e.belief);
  tactus_world_destroy(e.world);
  free(joints);
  return good;
}
