/* SPDX-License-Identifier: BSD-3-Clause */
/* Finds a socket by touch and plugs in: shelf_loop SCENARIO SEED EXPANSIONS. Prints the same as shelf_loop.py. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <tactus/tactus.h>

static void must(tactus_status status) {
  if (status < 100) return;
  fprintf(stderr, "%s: %s\n", tactus_status_name(status), tactus_last_error());
  exit(2);
}

int main(int argc, char** argv) {
  if (argc != 4) return fprintf(stderr, "usage: shelf_loop SCENARIO SEED EXPANSIONS\n"), 2;
  tactus_scenario* scenario;
  size_t dof;
  double start[16], joints[16], true_pose[7];
  must(tactus_scenario_load(argv[1], &scenario));
  must(tactus_scenario_start(scenario, start, 16, &dof));
  tactus_limits limits = {.struct_size = sizeof limits};
  must(tactus_scenario_limits(scenario, &limits));
  tactus_planner_options options = {.struct_size = sizeof options};
  must(tactus_scenario_planner_options(scenario, &options));
  options.seed = strtoull(argv[2], NULL, 10);
  options.budget_expansions = strtoull(argv[3], NULL, 10);
  options.budget_seconds = (double)INFINITY;
  tactus_planner* planner;
  tactus_belief* belief;
  tactus_world* world; /* your robot goes here */
  must(tactus_planner_create(scenario, &options, &planner));
  must(tactus_belief_create(scenario, NULL, start, &belief));
  must(tactus_scenario_sample_pose(scenario, options.seed, true_pose));
  must(tactus_world_create(scenario, true_pose, NULL, &world));
  tactus_observation seen = {sizeof seen, 0, dof, joints};
  tactus_summary summary = {.struct_size = sizeof summary};
  tactus_action_properties info = {.struct_size = sizeof info};
  tactus_action* action;
  for (int step = 1; step <= limits.actions; ++step) {
    must(tactus_planner_query_action(planner, belief, &action));
    if (action == NULL) break; /* the goal is reached, or nothing is worth trying */
    must(tactus_world_execute(world, action, &seen));
    must(tactus_belief_step(belief, action, &seen));
    must(tactus_belief_summary(belief, &summary));
    must(tactus_action_info(action, &info));
    printf("%d %s %s %" PRIu64 " voxels %" PRIu64 " cells\n", step, tactus_action_kind_name(info.kind),
           seen.contact ? "contact" : "free", summary.possibly_occupied, summary.cells);
    tactus_action_destroy(action);
  }
  int32_t inserted;
  must(tactus_world_inserted(world, &inserted));
  puts(inserted ? "inserted" : "not inserted");
  tactus_world_destroy(world);
  tactus_belief_destroy(belief);
  tactus_planner_destroy(planner);
  tactus_scenario_destroy(scenario);
  return inserted ? 0 : 1;
}
