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
  const trial_course* course;
  trial_result* result;
  tactus_world* world;
  tactus_belief* belief;
  tactus_planner* planner;
  tactus_observation observation; /* of the last action */
  tactus_summary summary;         /* of the belief as it is */
  int32_t planned_on;             /* as it was at the last query */
  tactus_statistics statistics;   /* of the last query */
  double led_m, led_rad;          /* what the tool frame went and turned until the trial began */
  recording* record;              /* may be NULL */
  time_t began;
} episode;

/* --- what is measured */

/* Notes the hand-over when it comes. */
static void notice_hand_over(episode* e) {
  trial_result* r = e->result;
  const bool has_voxels = e->setup->belief.kind == TACTUS_BELIEF_HIERARCHICAL && e->course->from == NULL;
  if (has_voxels && e->summary.phase == TACTUS_PHASE_POSES && isnan(r->voxels.cost_m)) r->voxels = r->whole;
}

static void notice_plan(episode* e) {
  static const double late = 1.05;
  trial_result* r = e->result;
  if (e->planned_on == TACTUS_PHASE_POSES && isnan(r->poses_value)) {
    r->poses_lower_bound = e->statistics.lower_bound;
    r->poses_value = e->statistics.value;
  }
  r->slowest_planning_s = fmax(r->slowest_planning_s, e->statistics.seconds);
  r->late_plans += e->statistics.seconds > late * e->setup->planner.budget_seconds;
}

static tactus_status measure(episode* e) {
  effort* whole = &e->result->whole;
  const tactus_costs* costs = &e->setup->costs;
  tactus_status status = tactus_world_travelled(e->world, &whole->travel_m, &whole->rotation_rad);
  if (status == TACTUS_OK) status = tactus_belief_summary(e->belief, &e->summary);
  if (status == TACTUS_OK) status = tactus_planner_statistics(e->planner, &e->statistics);
  if (status != TACTUS_OK) return status;
  whole->travel_m -= e->led_m;
  whole->rotation_rad -= e->led_rad;
  whole->cost_m = costs->metre * whole->travel_m + costs->radian * whole->rotation_rad + costs->action * whole->actions;
  if ((double)e->statistics.total_calls > whole->planner_calls) notice_plan(e);
  whole->planner_calls = (double)e->statistics.total_calls;
  whole->planning_s = e->statistics.total_seconds;
  e->result->expansions = e->statistics.total_expansions;
  notice_hand_over(e);
  return TACTUS_OK;
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

static const char* solver_name(const episode* e) { return tactus_solver_name(e->setup->planner.solver); }

static void print_progress(const episode* e, const char* kind) {
  const trial_result* r = e->result;
  const bool voxels = e->summary.phase == TACTUS_PHASE_VOXELS;
  fprintf(stderr,
          "seed %-4" PRIu64 " %-9s %3.0f  %-9s  %-10s  %s %6" PRIu64
          "  %5.1f bits  cost %7.3f  planning %6.2f s  stepping %6.2f s%s\n",
          r->seed, solver_name(e), r->whole.actions, kind, e->observation.contact ? "contact" : "no contact",
          voxels ? "voxels" : "cells ", voxels ? e->summary.possibly_occupied : e->summary.cells, e->summary.bits,
          r->whole.cost_m, r->whole.planning_s, r->stepping_s,
          e->summary.health == TACTUS_HEALTH_GOOD ? "" : "  contradicted");
}

static double seconds_now(void) {
  struct timespec now = {0, 0};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static tactus_status take_in(episode* e, const tactus_action* action) {
  const double began = seconds_now();
  const tactus_status status = tactus_belief_step(e->belief, action, &e->observation);
  const double seconds = seconds_now() - began;
  e->result->stepping_s += seconds;
  e->result->slowest_step_s = fmax(e->result->slowest_step_s, seconds);
  return status;
}

/* Executes an action, and takes in what is seen. */
static tactus_status perform(episode* e, const tactus_action* action) {
  trial_result* r = e->result;
  tactus_action_properties properties;
  int32_t kept = 0;
  tactus_action_properties_init(&properties, sizeof properties);
  tactus_status status = tactus_action_info(action, &properties);
  if (status == TACTUS_OK) status = tactus_world_execute(e->world, action, &e->observation);
  if (status == TACTUS_OK) status = take_in(e, action);
  if (status == TACTUS_OK) status = tactus_belief_contains(e->belief, r->true_pose, &kept);
  if (status != TACTUS_OK) return status;
  r->whole.actions += 1.0;
  r->contacts += e->observation.contact;
  r->truth_kept = r->truth_kept && kept != 0;
  status = measure(e);
  if (status != TACTUS_OK) return status;
  const char* kind = tactus_action_kind_name(properties.kind);
  print_progress(e, kind);
  const step_facts facts = {e->planner,         kind, r->whole.cost_m, r->whole.planning_s, e->statistics.lower_bound,
                            e->statistics.value};
  if (e->record != NULL && !record_step(e->record, action, &e->observation, e->belief, &facts)) return TACTUS_INTERNAL;
  return TACTUS_OK;
}

static trial_end end_reached(const episode* e) {
  const tactus_limits* limits = &e->setup->limits;
  if (e->course->until_hand_over && !isnan(e->result->voxels.cost_m)) return trial_at_hand_over;
  if (e->result->whole.actions >= limits->actions) return trial_at_limit_of_actions;
  if (e->result->whole.travel_m >= limits->travel) return trial_at_limit_of_travel;
  if (difftime(time(NULL), e->began) >= limits->seconds) return trial_at_limit_of_time;
  return trial_goes_on;
}

static trial_end ending(const episode* e, tactus_status status) {
  if (status == TACTUS_GOAL_REACHED) return trial_at_goal;
  if (status == TACTUS_NO_INFORMATIVE_ACTION) return trial_out_of_actions;
  if (status == TACTUS_CANCELLED) return trial_cancelled;
  fprintf(stderr, "tactus: seed %" PRIu64 ": %s: %s: %s\n", e->result->seed, solver_name(e), tactus_status_name(status),
          tactus_last_error());
  return trial_failed;
}

/* The action is the head start's from now on. */
static tactus_status keep_action(head_start* start, tactus_action* action) {
  if (start->count == start->room) {
    const int room = 2 * start->room + 16;
    tactus_action** actions = realloc(start->actions, (size_t)room * sizeof *actions);
    if (actions == NULL) {
      tactus_action_destroy(action);
      return TACTUS_OUT_OF_MEMORY;
    }
    start->actions = actions;
    start->room = room;
  }
  start->actions[start->count++] = action;
  return TACTUS_OK;
}

static tactus_status step(episode* e) {
  tactus_action* action = NULL;
  e->planned_on = e->summary.phase;
  tactus_status status = tactus_planner_query_action(e->planner, e->belief, &action);
  if (status == TACTUS_OK) status = perform(e, action);
  if (status == TACTUS_OK && e->course->keep != NULL) return keep_action(e->course->keep, action);
  tactus_action_destroy(action);
  return status;
}

static tactus_status loop(episode* e) {
  tactus_status status = TACTUS_OK;
  e->result->ended = end_reached(e);
  while (e->result->ended == trial_goes_on) {
    status = step(e);
    e->result->ended = status == TACTUS_OK ? end_reached(e) : ending(e, status);
  }
  if (measure(e) != TACTUS_OK || measure_end(e) != TACTUS_OK) e->result->ended = ending(e, TACTUS_INTERNAL);
  return status;
}

/* --- a trial */

void free_head_start(head_start* start) {
  for (int i = 0; i < start->count; ++i) tactus_action_destroy(start->actions[i]);
  free(start->actions);
  tactus_belief_destroy(start->belief);
  memset(start, 0, sizeof *start);
}

/* The same world and the same actions: the robot comes to where it was. */
static tactus_status begin_from(episode* e, const head_start* start) {
  tactus_status status = tactus_belief_clone(start->belief, &e->belief);
  for (int i = 0; status == TACTUS_OK && i < start->count; ++i)
    status = tactus_world_execute(e->world, start->actions[i], &e->observation);
  return status == TACTUS_OK ? tactus_world_travelled(e->world, &e->led_m, &e->led_rad) : status;
}

static tactus_status begin(episode* e) {
  const trial_setup* setup = e->setup;
  tactus_planner_options planner = setup->planner;
  tactus_world_options world = setup->world;
  planner.seed = world.seed = e->result->seed;
  tactus_status status = tactus_world_create(setup->scenario, e->result->true_pose, &world, &e->world);
  if (status == TACTUS_OK)
    status = e->course->from != NULL ? begin_from(e, e->course->from)
                                     : tactus_belief_create(setup->scenario, &setup->belief, setup->start, &e->belief);
  if (status == TACTUS_OK) status = tactus_planner_create(setup->scenario, &planner, &e->planner);
  return status == TACTUS_OK ? measure(e) : status;
}

static bool begin_recording(episode* e) {
  FILE* file = e->course->record;
  if (file != NULL) e->record = record_begin(file, e->setup->scenario, e->belief, e->result->true_pose);
  return file == NULL || e->record != NULL;
}

static void init_result(trial_result* result, uint64_t seed, const double true_pose[7]) {
  memset(result, 0, sizeof *result);
  memcpy(result->true_pose, true_pose, sizeof result->true_pose);
  result->seed = seed;
  result->truth_kept = true;
  result->poses_lower_bound = result->poses_value = NAN;
  result->position_error_m = result->angle_error_rad = NAN;
  result->voxels = unknown_effort;
}

static void init_episode(episode* e, const trial_setup* setup, const trial_course* course, trial_result* result) {
  memset(e, 0, sizeof *e);
  e->setup = setup;
  e->course = course;
  e->result = result;
  e->began = time(NULL);
  tactus_summary_init(&e->summary, sizeof e->summary);
  tactus_statistics_init(&e->statistics, sizeof e->statistics);
  tactus_observation_init(&e->observation, sizeof e->observation);
}

static void keep_belief(episode* e) {
  head_start* kept = e->course->keep;
  kept->failed = e->result->ended == trial_failed;
  if (e->result->ended != trial_at_hand_over) return;
  kept->belief = e->belief;
  e->belief = NULL;
}

static void end(episode* e) {
  record_end(e->record, e->result->inserted);
  if (e->course->keep != NULL) keep_belief(e);
  tactus_planner_destroy(e->planner);
  tactus_belief_destroy(e->belief);
  tactus_world_destroy(e->world);
}

static void end_unbegun(trial_result* result, trial_end why) {
  result->ended = why;
  if (why == trial_failed) result->whole = unknown_effort;
}

/* An argument that is wrong is the command line's, and every trial has it. */
static bool play(episode* e) {
  const tactus_status begun = e->observation.joints != NULL ? begin(e) : TACTUS_OUT_OF_MEMORY;
  if (begun != TACTUS_OK) {
    end_unbegun(e->result, ending(e, begun));
    return begun != TACTUS_OUT_OF_MEMORY && begun != TACTUS_INVALID_ARGUMENT;
  }
  if (begin_recording(e)) return loop(e) != TACTUS_OUT_OF_MEMORY;
  fprintf(stderr, "tactus: seed %" PRIu64 ": --record: %s\n", e->result->seed, tactus_last_error());
  return false;
}

bool run_trial(const trial_setup* setup, uint64_t seed, const double true_pose[7], const trial_course* course,
               trial_result* result) {
  episode e;
  init_result(result, seed, true_pose);
  init_episode(&e, setup, course, result);
  if (course->from != NULL && course->from->belief == NULL) {
    end_unbegun(result, course->from->failed ? trial_failed : trial_without_hand_over);
    return true;
  }
  double* joints = malloc(setup->dof * sizeof *joints);
  e.observation.joints = joints;
  e.observation.joint_count = setup->dof;
  const bool good = play(&e);
  end(&e);
  free(joints);
  return good;
}
