/* SPDX-License-Identifier: BSD-3-Clause */
#include "result.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const char* trial_end_name(trial_end end) {
  static const char* const names[trial_end_count] = {
      "goes on",          "goal reached",    "no informative action", "cancelled", "error",
      "limit of actions", "limit of travel", "limit of time",         "hand-over", "no hand-over"};
  return names[end];
}

const char* trial_phase_name(trial_phase phase) {
  static const char* const names[phase_count] = {"whole", "voxels", "poses"};
  return names[phase];
}

const effort unknown_effort = {NAN, NAN, NAN, NAN, NAN, NAN};

void add_effort(effort* sum, const effort* other, double times) {
  sum->cost_m += times * other->cost_m;
  sum->travel_m += times * other->travel_m;
  sum->rotation_rad += times * other->rotation_rad;
  sum->actions += times * other->actions;
  sum->planner_calls += times * other->planner_calls;
  sum->planning_s += times * other->planning_s;
}

bool effort_of_phase(const trial_result* trial, trial_phase phase, effort* taken) {
  const bool handed_over = !isnan(trial->voxels.cost_m);
  *taken = phase == phase_voxels ? trial->voxels : trial->whole;
  if (phase == phase_voxels) return handed_over;
  if (phase == phase_poses && handed_over) add_effort(taken, &trial->voxels, -1.0);
  return trial->inserted || (phase == phase_whole && trial->ended == trial_at_hand_over);
}

static int compare_seeds(const void* seed, const void* trial) {
  const uint64_t one = *(const uint64_t*)seed, other = ((const trial_result*)trial)->seed;
  return (one > other) - (one < other);
}

const trial_result* find_trial(const run_result* run, uint64_t seed) {
  if (run->count == 0) return NULL;
  return bsearch(&seed, run->trials, (size_t)run->count, sizeof *run->trials, compare_seeds);
}

bool add_trial(run_result* run, const trial_result* trial) {
  if (run->count == run->room) {
    const int room = 2 * run->room + 16;
    trial_result* trials = realloc(run->trials, (size_t)room * sizeof *trials);
    if (trials == NULL) return false;
    run->trials = trials;
    run->room = room;
  }
  int at = run->count++;
  for (; at > 0 && run->trials[at - 1].seed > trial->seed; --at) run->trials[at] = run->trials[at - 1];
  run->trials[at] = *trial;
  return true;
}

static int compare_numbers(const void* a, const void* b) {
  const double one = *(const double*)a, other = *(const double*)b;
  return (one > other) - (one < other);
}

/* NAN if there is none, or no room to sort them. */
static double median_certificate(const run_result* run) {
  double* ratios = malloc(((size_t)run->count + 1) * sizeof *ratios);
  size_t count = 0;
  for (int i = 0; ratios != NULL && i < run->count; ++i)
    if (run->trials[i].poses_lower_bound > 0.0)
      ratios[count++] = run->trials[i].poses_value / run->trials[i].poses_lower_bound;
  if (count > 0) qsort(ratios, count, sizeof *ratios, compare_numbers);
  const double median = count > 0 ? 0.5 * (ratios[(count - 1) / 2] + ratios[count / 2]) : (double)NAN;
  free(ratios);
  return median;
}

static bool could_begin(const trial_result* trial) { return !isnan(trial->whole.cost_m); }

static void count_trials(const run_result* run, run_summary* sum) {
  sum->trials = run->count;
  for (int i = 0; i < run->count; ++i) {
    const trial_result* trial = &run->trials[i];
    sum->inserted += trial->inserted;
    sum->truth_kept += trial->truth_kept;
    sum->begun += could_begin(trial);
    sum->late_plans += trial->late_plans;
    sum->slowest_planning_s = fmax(sum->slowest_planning_s, trial->slowest_planning_s);
    sum->slowest_step_s = fmax(sum->slowest_step_s, trial->slowest_step_s);
  }
}

static void set_means(const run_result* run, run_summary* sum) {
  if (sum->begun == 0) {
    sum->mean = unknown_effort;
    sum->contacts = sum->expansions = sum->stepping_s = NAN;
    return;
  }
  const double share = 1.0 / sum->begun;
  for (int i = 0; i < run->count; ++i) {
    const trial_result* trial = &run->trials[i];
    if (!could_begin(trial)) continue;
    sum->contacts += share * trial->contacts;
    sum->expansions += share * (double)trial->expansions;
    sum->stepping_s += share * trial->stepping_s;
    add_effort(&sum->mean, &trial->whole, share);
  }
}

run_summary summarise(const run_result* run) {
  run_summary sum;
  memset(&sum, 0, sizeof sum);
  count_trials(run, &sum);
  set_means(run, &sum);
  sum.certificate = median_certificate(run);
  return sum;
}
