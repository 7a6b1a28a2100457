/* SPDX-License-Identifier: BSD-3-Clause */
#include <inttypes.h>
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "instance_options.h"
#include "json.h"

/* What is said of a policy on an instance; numbers are NAN where they are not known. */
typedef struct {
  char scenario[256];
  char solver[32];
  uint64_t budget_expansions, seed;
  uint64_t poses, configurations, motions, plans, expansions, beliefs;
  double discount, expected_cost, worst_cost, inserted, lower_bound, value, informed, pairs, optimum, ratio;
} evaluation;

static bool failed(const char* what) {
  fprintf(stderr, "tactus evaluate: %s\n", what);
  return false;
}

static bool choose_planner(const instance_options* o, const tactus_scenario* scenario,
                           tactus_planner_options* planner) {
  if (tactus_planner_options_init(planner, sizeof *planner) != TACTUS_OK ||
      tactus_scenario_planner_options(scenario, planner) != TACTUS_OK ||
      (o->solver != NULL && tactus_solver_from_name(o->solver, &planner->solver) != TACTUS_OK))
    return failed(tactus_last_error());
  planner->budget_seconds = (double)INFINITY;
  planner->budget_expansions = o->budget_expansions;
  return true;
}

static bool name_all(const instance_options* o, const tactus_scenario* scenario, const tactus_instance* instance,
                     tactus_solver solver, evaluation* e) {
  const char* name = "";
  size_t poses = 0, configurations = 0, motions = 0;
  if (tactus_scenario_name(scenario, &name) != TACTUS_OK ||
      tactus_instance_size(instance, &poses, &configurations, &motions) != TACTUS_OK)
    return failed(tactus_last_error());
  snprintf(e->scenario, sizeof e->scenario, "%s", name);
  snprintf(e->solver, sizeof e->solver, "%s", tactus_solver_name(solver));
  e->poses = poses;
  e->configurations = configurations;
  e->motions = motions;
  e->seed = o->instance.seed;
  e->discount = o->instance.discount;
  e->budget_expansions = o->budget_expansions;
  return true;
}

static bool measure(const instance_options* o, const tactus_scenario* scenario, const tactus_instance* instance,
                    evaluation* e) {
  tactus_planner_options planner;
  tactus_evaluation run;
  memset(e, 0, sizeof *e);
  if (!choose_planner(o, scenario, &planner) || !name_all(o, scenario, instance, planner.solver, e)) return false;
  fprintf(stderr, "%s: running the policy at each of %" PRIu64 " poses\n", e->solver, e->poses);
  tactus_evaluation_init(&run, sizeof run);
  if (tactus_instance_evaluate(instance, &planner, &run) != TACTUS_OK) return failed(tactus_last_error());
  fprintf(stderr, "looking for the optimum\n");
  if (tactus_instance_bounds(instance, o->most_beliefs, &e->informed, &e->pairs) != TACTUS_OK ||
      tactus_instance_optimum(instance, o->most_beliefs, &e->optimum, &e->beliefs) != TACTUS_OK)
    return failed(tactus_last_error());
  e->expected_cost = run.expected_cost;
  e->worst_cost = run.worst_cost;
  e->inserted = run.inserted;
  e->lower_bound = run.lower_bound;
  e->value = run.value;
  e->plans = run.plans;
  e->expansions = run.expansions;
  e->ratio = run.inserted > 1.0 - 1e-9 ? run.expected_cost / e->optimum : (double)NAN;
  return true;
}

static void print_evaluation(FILE* out, const evaluation* e) {
  fprintf(out,
          "%s: %" PRIu64 " poses, %" PRIu64 " configurations, %" PRIu64 " motions, discount %g, seed %" PRIu64
          "\n%s, %" PRIu64 " expansions a plan\n\n",
          e->scenario, e->poses, e->configurations, e->motions, e->discount, e->seed, e->solver, e->budget_expansions);
  fprintf(out, "expected cost     %.6f\nworst cost        %.6f\ninserted          %.1f %%\n", e->expected_cost,
          e->worst_cost, 100.0 * e->inserted);
  if (isnan(e->optimum))
    fprintf(out, "optimum           not computed: more than %" PRIu64 " beliefs\n", e->beliefs - 1);
  else
    fprintf(out, "optimum           %.6f, of %" PRIu64 " beliefs\n", e->optimum, e->beliefs);
  fprintf(out, "at least          %.6f, were the pose known", e->informed);
  if (!isnan(e->pairs)) fprintf(out, "; %.6f by pairs of poses", e->pairs);
  fputc('\n', out);
  if (!isnan(e->ratio)) fprintf(out, "cost / optimum    %.4f\n", e->ratio);
  fprintf(out, "at the start      lower bound %.6f, value %.6f, undiscounted\n", e->lower_bound, e->value);
  fprintf(out, "plans             %" PRIu64 ", expansions %" PRIu64 "\n", e->plans, e->expansions);
}

#define MEMBER(key, type) \
  { #key, type, offsetof(evaluation, key), 1 }

static bool write_json(const char* path, const evaluation* e) {
  static const json_member members[] = {
      MEMBER(scenario, member_text),        MEMBER(solver, member_text),     MEMBER(budget_expansions, member_whole),
      MEMBER(seed, member_whole),           MEMBER(discount, member_double), MEMBER(poses, member_whole),
      MEMBER(configurations, member_whole), MEMBER(motions, member_whole),   MEMBER(expected_cost, member_double),
      MEMBER(worst_cost, member_double),    MEMBER(inserted, member_double), MEMBER(informed, member_double),
      MEMBER(pairs, member_double),         MEMBER(optimum, member_double),  MEMBER(ratio, member_double),
      MEMBER(lower_bound, member_double),   MEMBER(value, member_double),    MEMBER(plans, member_whole),
      MEMBER(expansions, member_whole),     MEMBER(beliefs, member_whole)};
  FILE* out = strcmp(path, "-") == 0 ? stdout : fopen(path, "w");
  bool good = out != NULL;
  if (good) {
    fputc('{', out);
    json_members(out, e, members, sizeof members / sizeof members[0], ",\n ");
    fputs("}\n", out);
    good = !ferror(out);
    good = (out == stdout ? fflush(out) : fclose(out)) == 0 && good;
  }
  if (!good) fprintf(stderr, "tactus evaluate: %s: found a file that can't be written\n", path);
  return good;
}

static int report(const instance_options* o, const evaluation* e) {
  print_evaluation(o->json != NULL && strcmp(o->json, "-") == 0 ? stderr : stdout, e);
  if (o->json != NULL && !write_json(o->json, e)) return exit_usage;
  return e->inserted > 1.0 - 1e-9 ? exit_good : exit_not_inserted;
}

int evaluate_command(int argc, char** argv) {
  instance_options options;
  if (!parse_instance_options("evaluate", argc, argv, &options)) return exit_usage;
  tactus_scenario* scenario = NULL;
  tactus_instance* instance = NULL;
  evaluation e;
  const bool measured =
      load_instance("evaluate", &options, &scenario, &instance) && measure(&options, scenario, instance, &e);
  tactus_instance_destroy(instance);
  tactus_scenario_destroy(scenario);
  return measured ? report(&options, &e) : exit_usage;
}
