/* SPDX-License-Identifier: BSD-3-Clause */
#include "comparison.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "student.h"

run_result* find_solver(comparison* c, const char* name) {
  for (int s = 0; s < c->solver_count; ++s)
    if (strcmp(c->results[s].setting.solver, name) == 0) return &c->results[s];
  return NULL;
}

const char* name_solvers(const char* names, comparison* c) {
  if (strlen(names) >= sizeof c->setting.solver) return "a shorter list";
  snprintf(c->setting.solver, sizeof c->setting.solver, "%s", names);
  for (const char* at = names; at != NULL; at = strchr(at, ',')) {
    at += *at == ',';
    char name[solvers_room];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(at, ","), at);
    if (find_solver(c, name) != NULL) return "each solver once";
    if (c->solver_count == most_solvers) return "at most 16 solvers";
    strcpy(c->results[c->solver_count++].setting.solver, name);
  }
  return c->solver_count >= 2 ? NULL : "two or more solvers, such as rtdp-bel,tbl";
}

void free_comparison(comparison* c) {
  for (int s = 0; s < c->solver_count; ++s) free(c->results[s].trials);
}

static bool others_have(const comparison* c, int solver, uint64_t seed) {
  for (int s = 0; s < c->solver_count; ++s)
    if (s != solver && find_trial(&c->results[s], seed) == NULL) return false;
  return true;
}

void forget_half_done(comparison* c) {
  for (int s = 0; s < c->solver_count; ++s) {
    run_result* run = &c->results[s];
    int kept = 0;
    for (int i = 0; i < run->count; ++i)
      if (others_have(c, s, run->trials[i].seed)) run->trials[kept++] = run->trials[i];
    run->count = kept;
  }
}

/* --- beside the first solver */

/* What a phase took in a solver's trial i, and in the first's at the same pose; false if one did not get to its end. */
static bool pair_up(const comparison* c, int solver, int i, trial_phase phase, effort* taken, effort* by_first) {
  const trial_result* trial = &c->results[solver].trials[i];
  const trial_result* first = find_trial(&c->results[0], trial->seed);
  return first != NULL && effort_of_phase(trial, phase, taken) && effort_of_phase(first, phase, by_first);
}

static const effort nothing;

static double ratio(double a, double b) { return b > 0.0 ? a / b : (double)NAN; }

/* Of a ratio of sums over pairs: Student's, on its logarithm, with the variance from the residuals a - ratio b [the
 * ratio estimator, Cochran 1977, 6.4]. */
static void set_interval(const comparison* c, int solver, trial_phase phase, double first_sum, standing* made) {
  effort taken, by_first;
  const double n = made->common;
  double squares = 0.0;
  for (int i = 0; i < c->results[solver].count; ++i) {
    if (!pair_up(c, solver, i, phase, &taken, &by_first)) continue;
    const double residual = taken.cost_m - made->cost_ratio * by_first.cost_m;
    squares += residual * residual;
  }
  const double error = sqrt(n * squares / (n - 1.0)) / first_sum;
  const double factor = exp(student_95(made->common - 1) * error / made->cost_ratio);
  made->cost_ratio_low = made->cost_ratio / factor;
  made->cost_ratio_high = made->cost_ratio * factor;
}

static void set_ratios(const comparison* c, int solver, trial_phase phase, standing* made) {
  effort taken, by_first, sum = nothing, first_sum = nothing;
  for (int i = 0; i < c->results[solver].count; ++i) {
    if (!pair_up(c, solver, i, phase, &taken, &by_first)) continue;
    ++made->common;
    add_effort(&sum, &taken, 1.0);
    add_effort(&first_sum, &by_first, 1.0);
  }
  made->cost_ratio = ratio(sum.cost_m, first_sum.cost_m);
  made->planning_ratio = ratio(sum.planning_s, first_sum.planning_s);
  made->calls_ratio = ratio(sum.planner_calls, first_sum.planner_calls);
  made->time_per_call_ratio = ratio(made->planning_ratio, made->calls_ratio);
  set_interval(c, solver, phase, first_sum.cost_m, made);
}

standing compare_to_first(const comparison* c, int solver, trial_phase phase) {
  const run_result* run = &c->results[solver];
  standing made;
  effort taken, sum = nothing;
  memset(&made, 0, sizeof made);
  for (int i = 0; i < run->count; ++i) {
    if (!effort_of_phase(&run->trials[i], phase, &taken)) continue;
    ++made.finished;
    add_effort(&sum, &taken, 1.0);
  }
  add_effort(&made.mean, &sum, made.finished > 0 ? 1.0 / made.finished : (double)NAN);
  set_ratios(c, solver, phase, &made);
  return made;
}

bool all_finished(const comparison* c) {
  for (int s = 0; s < c->solver_count; ++s)
    if (compare_to_first(c, s, phase_whole).finished < c->results[s].count) return false;
  return true;
}
