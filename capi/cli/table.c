/* SPDX-License-Identifier: BSD-3-Clause */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "result.h"

static const double degrees = 57.29577951308232;

static void print_number(FILE* out, int width, int decimals, double value) {
  if (isnan(value))
    fprintf(out, "  %*s", width, "-");
  else
    fprintf(out, "  %*.*f", width, decimals, value);
}

static void print_row(FILE* out, const trial_result* t) {
  fprintf(out, "%8" PRIu64 "  %-8s  %-5s", t->seed, t->inserted ? "yes" : "no", t->truth_kept ? "kept" : "lost");
  print_number(out, 7, 3, t->whole.cost_m);
  print_number(out, 8, 3, t->whole.travel_m);
  print_number(out, 8, 3, t->whole.rotation_rad);
  print_number(out, 7, 0, t->whole.actions);
  fprintf(out, "  %8d", t->contacts);
  print_number(out, 5, 0, t->whole.planner_calls);
  print_number(out, 10, 2, t->whole.planning_s);
  print_number(out, 8, 2, 1000.0 * t->position_error_m);
  print_number(out, 9, 2, degrees * t->angle_error_rad);
  fprintf(out, "  %s\n", trial_end_name(t->ended));
}

static void print_rows(FILE* out, const run_result* run) {
  fprintf(out, "%8s  %-8s  %-5s  %7s  %8s  %8s  %7s  %8s  %5s  %10s  %8s  %9s  %s\n", "seed", "inserted", "truth",
          "cost m", "travel m", "turn rad", "actions", "contacts", "plans", "planning s", "error mm", "error deg",
          "ended");
  for (int i = 0; i < run->count; ++i) print_row(out, &run->trials[i]);
}

static void print_means(FILE* out, const run_summary* summary) {
  const effort* mean = &summary->mean;
  fprintf(out,
          "on average: cost %.3f m, travel %.3f m, %.1f actions, %.1f contacts, %.2f s of planning in %.1f calls, %.1f "
          "beliefs expanded a second\n",
          mean->cost_m, mean->travel_m, mean->actions, summary->contacts, mean->planning_s, mean->planner_calls,
          mean->planning_s > 0.0 ? summary->expansions / mean->planning_s : 0.0);
}

static void print_times(FILE* out, const run_summary* summary, double budget_seconds) {
  const effort* mean = &summary->mean;
  fprintf(out, "slowest plan: %.2f s; ", summary->slowest_planning_s);
  if (isnan(budget_seconds))
    fputs("no budget in seconds\n", out);
  else
    fprintf(out, "%d of %.0f took over 5 %% longer than the %g s allowed\n", summary->late_plans,
            mean->planner_calls * summary->begun, budget_seconds);
  fprintf(out, "taking in what was felt: %.3f s an observation, the slowest %.2f s\n",
          mean->actions > 0.0 ? summary->stepping_s / mean->actions : 0.0, summary->slowest_step_s);
}

void print_table(FILE* out, const run_result* run) {
  const run_summary summary = summarise(run);
  fprintf(out, "%s, %s, %s\n\n", run->setting.scenario, run->setting.solver, run->setting.belief);
  print_rows(out, run);
  fprintf(out, "\ninserted %d of %d, true pose kept in %d of %d\n", summary.inserted, run->count, summary.truth_kept,
          run->count);
  if (summary.begun == 0) return;
  print_means(out, &summary);
  if (!isnan(summary.certificate))
    fprintf(out, "first plan on poses: value %.2f times the lower bound in the median\n", summary.certificate);
  print_times(out, &summary, run->setting.budget_seconds);
}
