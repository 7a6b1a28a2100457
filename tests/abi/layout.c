/* SPDX-License-Identifier: BSD-3-Clause */
/* The structs and codes as they were released. Fields are appended only: a line here never changes, and a new field
 * adds one. Compiled, not run. */
#include <stddef.h>
#include <tactus/tactus.h>

#define AT(type, field, offset) _Static_assert(offsetof(type, field) == (offset), #type "." #field " has moved")
#define SIZE(type, size) _Static_assert(sizeof(type) == (size), #type " has another size")

AT(tactus_costs, struct_size, 0);
AT(tactus_costs, metre, 8);
AT(tactus_costs, radian, 16);
AT(tactus_costs, action, 24);
SIZE(tactus_costs, 32);

AT(tactus_limits, struct_size, 0);
AT(tactus_limits, actions, 4);
AT(tactus_limits, travel, 8);
AT(tactus_limits, seconds, 16);
SIZE(tactus_limits, 24);

AT(tactus_observation, struct_size, 0);
AT(tactus_observation, contact, 4);
AT(tactus_observation, joint_count, 8);
AT(tactus_observation, joints, 16);
SIZE(tactus_observation, 24);

AT(tactus_action_properties, struct_size, 0);
AT(tactus_action_properties, kind, 4);
AT(tactus_action_properties, id, 8);
AT(tactus_action_properties, waypoints, 16);
AT(tactus_action_properties, length, 24);
AT(tactus_action_properties, duration, 32);
AT(tactus_action_properties, full_cost, 40);
AT(tactus_action_properties, expected_cost, 48);
AT(tactus_action_properties, contact_probability, 56);
SIZE(tactus_action_properties, 64);

AT(tactus_belief_options, struct_size, 0);
AT(tactus_belief_options, kind, 4);
SIZE(tactus_belief_options, 8);

AT(tactus_summary, struct_size, 0);
AT(tactus_summary, phase, 4);
AT(tactus_summary, health, 8);
AT(tactus_summary, doubted, 12);
AT(tactus_summary, observations, 16);
AT(tactus_summary, contacts, 24);
AT(tactus_summary, possibly_occupied, 32);
AT(tactus_summary, volume, 40);
AT(tactus_summary, cells, 48);
AT(tactus_summary, bits, 56);
AT(tactus_summary, mean, 64);
AT(tactus_summary, extent, 112);
AT(tactus_summary, covariance, 160);
SIZE(tactus_summary, 448);

AT(tactus_planner_options, struct_size, 0);
AT(tactus_planner_options, solver, 4);
AT(tactus_planner_options, budget_seconds, 8);
AT(tactus_planner_options, budget_expansions, 16);
AT(tactus_planner_options, epsilon, 24);
AT(tactus_planner_options, horizon, 32);
AT(tactus_planner_options, seed, 40);
SIZE(tactus_planner_options, 48);

AT(tactus_statistics, struct_size, 0);
AT(tactus_statistics, from_policy, 4);
AT(tactus_statistics, expansions, 8);
AT(tactus_statistics, seconds, 16);
AT(tactus_statistics, lower_bound, 24);
AT(tactus_statistics, value, 32);
AT(tactus_statistics, total_calls, 40);
AT(tactus_statistics, total_expansions, 48);
AT(tactus_statistics, total_seconds, 56);
SIZE(tactus_statistics, 64);

AT(tactus_alternative, struct_size, 0);
AT(tactus_alternative, kind, 4);
AT(tactus_alternative, verdict, 8);
AT(tactus_alternative, outcomes, 12);
AT(tactus_alternative, lower_bound, 16);
AT(tactus_alternative, value, 24);
AT(tactus_alternative, motion_cost, 32);
AT(tactus_alternative, information, 40);
AT(tactus_alternative, contact_probability, 48);
AT(tactus_alternative, goal_probability, 56);
AT(tactus_alternative, start, 64);
AT(tactus_alternative, end, 88);
SIZE(tactus_alternative, 112);

AT(tactus_world_options, struct_size, 0);
AT(tactus_world_options, fineness, 4);
AT(tactus_world_options, seed, 8);
AT(tactus_world_options, stopping_distance, 16);
AT(tactus_world_options, encoder_error, 24);
AT(tactus_world_options, missed_contacts, 32);
AT(tactus_world_options, false_contacts, 40);
SIZE(tactus_world_options, 48);

AT(tactus_instance_options, struct_size, 0);
AT(tactus_instance_options, poses, 4);
AT(tactus_instance_options, configurations, 8);
AT(tactus_instance_options, motions, 12);
AT(tactus_instance_options, discount, 16);
AT(tactus_instance_options, seed, 24);
SIZE(tactus_instance_options, 32);

AT(tactus_evaluation, struct_size, 0);
AT(tactus_evaluation, expected_cost, 8);
AT(tactus_evaluation, worst_cost, 16);
AT(tactus_evaluation, inserted, 24);
AT(tactus_evaluation, lower_bound, 32);
AT(tactus_evaluation, value, 40);
AT(tactus_evaluation, plans, 48);
AT(tactus_evaluation, expansions, 56);
SIZE(tactus_evaluation, 64);

#define VALUE(name, value) _Static_assert((name) == (value), #name " has another value")

VALUE(TACTUS_OK, 0);
VALUE(TACTUS_GOAL_REACHED, 1);
VALUE(TACTUS_NO_INFORMATIVE_ACTION, 2);
VALUE(TACTUS_CANCELLED, 3);
VALUE(TACTUS_INVALID_ARGUMENT, 100);
VALUE(TACTUS_BUFFER_TOO_SMALL, 101);
VALUE(TACTUS_STRUCT_SIZE, 102);
VALUE(TACTUS_BUSY, 103);
VALUE(TACTUS_STOP_OFF_PATH, 104);
VALUE(TACTUS_WRONG_SCENARIO, 105);
VALUE(TACTUS_FILE_NOT_FOUND, 200);
VALUE(TACTUS_FILE_UNREADABLE, 201);
VALUE(TACTUS_BAD_MESH, 202);
VALUE(TACTUS_BAD_ROBOT, 203);
VALUE(TACTUS_BAD_SCENARIO, 204);
VALUE(TACTUS_BAD_SAVED_STATE, 205);
VALUE(TACTUS_START_IN_COLLISION, 300);
VALUE(TACTUS_PRIOR_UNREACHABLE, 301);
VALUE(TACTUS_MOTION_INFEASIBLE, 302);
VALUE(TACTUS_OUT_OF_MEMORY, 900);
VALUE(TACTUS_INTERNAL, 901);

VALUE(TACTUS_ACTION_MOVE, 1);
VALUE(TACTUS_ACTION_TURN, 2);
VALUE(TACTUS_ACTION_SWEEP, 3);
VALUE(TACTUS_ACTION_POKE, 4);
VALUE(TACTUS_ACTION_INSERTION, 5);

VALUE(TACTUS_BODY_ROBOT, 1);
VALUE(TACTUS_BODY_TOOL, 2);
VALUE(TACTUS_BODY_WORLD, 3);
VALUE(TACTUS_BODY_TARGET, 4);

VALUE(TACTUS_BELIEF_HIERARCHICAL, 1);
VALUE(TACTUS_BELIEF_PARTICLES, 2);
VALUE(TACTUS_PHASE_VOXELS, 1);
VALUE(TACTUS_PHASE_POSES, 2);
VALUE(TACTUS_HEALTH_GOOD, 0);
VALUE(TACTUS_HEALTH_CONTRADICTED, 1);

VALUE(TACTUS_SOLVER_RTDP_BEL, 1);
VALUE(TACTUS_SOLVER_RTDP_INAD, 2);
VALUE(TACTUS_SOLVER_RTDP_AD, 3);
VALUE(TACTUS_SOLVER_BRTDP_BEL, 4);
VALUE(TACTUS_SOLVER_TBL, 5);
VALUE(TACTUS_SOLVER_FRONTIER, 6);
VALUE(TACTUS_SOLVER_RATE, 7);

VALUE(TACTUS_VERDICT_PASSED_OVER, 0);
VALUE(TACTUS_VERDICT_CHOSEN, 1);
VALUE(TACTUS_VERDICT_UNREACHABLE, 2);
VALUE(TACTUS_VERDICT_SET_ASIDE, 3);

VALUE(TACTUS_FORMAT_POMDPX, 1);
VALUE(TACTUS_FORMAT_POMDP, 2);

VALUE(TACTUS_LOG_DEBUG, 0);
VALUE(TACTUS_LOG_INFO, 1);
VALUE(TACTUS_LOG_WARNING, 2);
VALUE(TACTUS_LOG_ERROR, 3);
