/* SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <string.h>

#include "comparison.h"

static void print_ratio(FILE* out, int width, double ratio) {
  if (isnan(ratio))
    fprintf(out, "  %*s", width, "-");
  else
    fprintf(out, "  %*.2f", width, ratio);
}

static void print_row(FILE* out, const char* solver, int trials, const standing* s) {
  char finished[32], interval[32] = "-";
  snprintf(finished, sizeof finished, "%d of %d", s->finished, trials);
  if (!isnan(s->cost_ratio_low))
    snprintf(interval, sizeof interval, "%.2f to %.2f", s->cost_ratio_low, s->cost_ratio_high);
  fprintf(out, "%-10s  %12s", solver, finished);
  print_ratio(out, 7, s->mean.cost_m);
  print_ratio(out, 8, s->mean.rotation_rad);
  print_ratio(out, 7, s->mean.actions);
  print_ratio(out, 6, s->mean.planner_calls);
  print_ratio(out, 10, s->mean.planning_s);
  fprintf(out, "  |  %4d", s->common);
  print_ratio(out, 5, s->cost_ratio);
  fprintf(out, "  %16s", interval);
  print_ratio(out, 8, s->planning_ratio);
  print_ratio(out, 5, s->calls_ratio);
  print_ratio(out, 8, s->time_per_call_ratio);
  fputc('\n', out);
}

static void print_phase(FILE* out, const comparison* c, trial_phase phase, const char* title) {
  fprintf(out, "\n%s\n%-10s  %12s  %7s  %8s  %7s  %6s  %10s  |  %4s  %5s  %16s  %8s  %5s  %8s\n", title, "solver",
          "finished", "cost m", "turn rad", "actions", "calls", "planning s", "both", "cost", "95 %", "planning",
          "calls", "s a call");
  for (int s = 0; s < c->solver_count; ++s) {
    const standing row = compare_to_first(c, s, phase);
    print_row(out, c->results[s].setting.solver, c->results[s].count, &row);
  }
}

void print_comparison(FILE* out, const comparison* c) {
  const bool whole = strcmp(c->setting.phase, trial_phase_name(phase_whole)) == 0;
  const bool hierarchical = strcmp(c->setting.belief, "hierarchical") == 0;
  fprintf(out, "%s, %s\n", c->setting.scenario, c->setting.belief);
  if (whole) print_phase(out, c, phase_whole, "whole");
  if (hierarchical && strcmp(c->setting.phase, trial_phase_name(phase_poses)) != 0)
    print_phase(out, c, phase_voxels, "voxels");
  if (hierarchical && strcmp(c->setting.phase, trial_phase_name(phase_voxels)) != 0)
    print_phase(out, c, phase_poses, "poses");
  fprintf(
      out,
      "\nOn average over a solver's finished trials; right of the bar sums over the poses that it and %s both finish, "
      "as shares of those of %s.\n",
      c->results[0].setting.solver, c->results[0].setting.solver);
}
