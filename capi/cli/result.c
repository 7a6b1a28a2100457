/* SPDX-License-Identifier: BSD-3-Clause */
#include "result.h"

#include <stdlib.h>
#include <string.h>

const char* trial_end_name(trial_end end) {
  static const char* const names[trial_end_count] = {"goes on",         "goal reached", "no informative action",
                                                     "cancelled",       "error",        "limit of actions",
                                                     "limit of travel", "limit of time"};
  return names[end];
}

bool has_trial(const run_result* run, uint64_t seed) {
  for (int i = 0; i < run->count; ++i)
    if (run->trials[i].seed == seed) return true;
  return false;
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

run_summary summarise(const run_result* run) {
  run_summary sum;
  memset(&sum, 0, sizeof sum);
  sum.trials = run->count;
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
