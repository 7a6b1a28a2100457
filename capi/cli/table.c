/* SPDX-License-Identifier: BSD-3-Clause */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "result.h"

static const double degrees = 57.29577951308232;

void print_table(FILE* out, const run_result* run) {
  fprintf(out, "%s, %s, %s\n\n", run->setting.scenario, run->setting.solver, run->setting.belief);
  fprintf(out, "%8s  %-8s  %-5s  %7s  %8s  %8s  %7s  %8s  %5s  %10s  %8s  %8s  %s\n", "seed", "inserted", "truth",
          "cost m", "travel m", "turn rad", "actions", "contacts", "plans", "planning s", "error mm", "error deg",
          "ended");
  for (int i = 0; i < run->count; ++i) {
    const trial_result* t = &run->trials[i];
    fprintf(out, "%8" PRIu64 "  %-8s  %-5s  %7.3f  %8.3f  %8.3f  %7.0f  %8d  %5.0f  %10.2f  %8.2f  %9.2f  %s\n",
            t->seed, t->inserted ? "yes" : "no", t->truth_kept ? "kept" : "lost", t->whole.cost_m, t->whole.travel_m,
            t->whole.rotation_rad, t->whole.actions, t->contacts, t->whole.planner_calls, t->whole.planning_s,
            1000.0 * t->position_error_m, degrees * t->angle_error_rad, trial_end_name(t->ended));
  }
  const run_summary summary = summarise(run);
  const effort* mean = &summary.mean;
  fprintf(out, "\ninserted %d of %d, true pose kept in %d of %d\n", summary.inserted, run->count, summary.truth_kept,
          run->count);
  fprintf(out,
          "on average: cost %.3f m, travel %.3f m, %.1f actions, %.1f contacts, %.2f s of planning in %.1f calls, %.1f "
          "beliefs expanded a second\n",
          mean->cost_m, mean->travel_m, mean->actions, summary.contacts, mean->planning_s, mean->planner_calls,
          mean->planning_s > 0.0 ? summary.expansions / mean->planning_s : 0.0);
  if (!isnan(summary.certificate))
    fprintf(out, "first plan on poses: value %.2f times the lower bound in the median\n", summary.certificate);
  fprintf(out, "slowest plan: %.2f s; ", summary.slowest_planning_s);
  if (isnan(run->setting.budget_seconds))
    fputs("no budget in seconds\n", out);
  else
    fprintf(out, "%d of %.0f took over 5 %% longer than the %g s allowed\n", summary.late_plans,
            mean->planner_calls * run->count, run->setting.budget_seconds);
  fprintf(out, "taking in what was felt: %.3f s an observation, the slowest %.2f s\n",
          mean->actions > 0.0 ? summary.stepping_s / mean->actions : 0.0, summary.slowest_step_s);
}
