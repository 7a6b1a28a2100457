// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>
#include <tactus/tactus.h>

#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

/// A small search in the shelf of the examples through the C ABI, with handles that give themselves back.
namespace shelf {

inline const std::string folder = std::string(TACTUS_SOURCE_DIR) + "/tests/capi";
inline const std::string file = folder + "/small_shelf.yaml";
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

template <typename T, void (*destroy)(T*) noexcept>
struct Destroy {
  void operator()(T* handle) const { destroy(handle); }
};
using Scenario = std::unique_ptr<tactus_scenario, Destroy<tactus_scenario, tactus_scenario_destroy>>;
using Belief = std::unique_ptr<tactus_belief, Destroy<tactus_belief, tactus_belief_destroy>>;
using Planner = std::unique_ptr<tactus_planner, Destroy<tactus_planner, tactus_planner_destroy>>;
using Action = std::unique_ptr<tactus_action, Destroy<tactus_action, tactus_action_destroy>>;
using World = std::unique_ptr<tactus_world, Destroy<tactus_world, tactus_world_destroy>>;

/// A status of this kind, and a text in which the word stands.
inline void expect_refused(tactus_status got, tactus_status expected, const std::string& word) {
  EXPECT_STREQ(tactus_status_name(got), tactus_status_name(expected));
  EXPECT_NE(std::string(tactus_last_error()).find(word), std::string::npos)
      << "'" << word << "' is not in: " << tactus_last_error();
}

inline void expect_ok(tactus_status got) { EXPECT_EQ(got, TACTUS_OK) << tactus_last_error(); }

inline Scenario load(const std::string& path = file) {
  tactus_scenario* scenario = nullptr;
  expect_ok(tactus_scenario_load(path.c_str(), &scenario));
  return Scenario(scenario);
}

/// One for all the tests of a program.
inline const tactus_scenario* scenario() {
  static const Scenario loaded = load();
  return loaded.get();
}

inline std::vector<double> start(const tactus_scenario* of = scenario()) {
  std::vector<double> q(6);
  std::size_t count = 0;
  expect_ok(tactus_scenario_start(of, q.data(), q.size(), &count));
  return q;
}

inline std::vector<double> pose(std::uint64_t seed, const tactus_scenario* of = scenario()) {
  std::vector<double> drawn(7);
  expect_ok(tactus_scenario_sample_pose(of, seed, drawn.data()));
  return drawn;
}

inline Belief belief(const tactus_scenario* of = scenario(), tactus_belief_kind kind = TACTUS_BELIEF_HIERARCHICAL) {
  tactus_belief_options options{sizeof options, kind};
  tactus_belief* made = nullptr;
  expect_ok(tactus_belief_create(of, &options, start(of).data(), &made));
  return Belief(made);
}

/// With a budget of a few expansions, so that tests are quick and the same everywhere. 0: the scenario's solver.
inline Planner planner(const tactus_scenario* of = scenario(), std::uint64_t expansions = 2, tactus_solver solver = 0) {
  tactus_planner_options options{};
  expect_ok(tactus_planner_options_init(&options, sizeof options));
  expect_ok(tactus_scenario_planner_options(of, &options));
  options.budget_seconds = infinity;
  options.budget_expansions = expansions;
  if (solver != 0) options.solver = solver;
  tactus_planner* made = nullptr;
  expect_ok(tactus_planner_create(of, &options, &made));
  return Planner(made);
}

inline World world(std::uint64_t seed = 1, const tactus_scenario* of = scenario()) {
  tactus_world* made = nullptr;
  expect_ok(tactus_world_create(of, pose(seed, of).data(), nullptr, &made));
  return World(made);
}

inline Action query(const Planner& planner, const Belief& belief) {
  tactus_action* action = nullptr;
  expect_ok(tactus_planner_query_action(planner.get(), belief.get(), &action));
  return Action(action);
}

/// The first action from the start; made once.
inline const tactus_action* first_action() {
  static const Action action = query(planner(), belief());
  return action.get();
}

inline std::vector<double> waypoints(const tactus_action* action) {
  std::size_t count = 0;
  expect_ok(tactus_action_waypoints(action, nullptr, 0, &count));
  std::vector<double> rows(6 * count);
  expect_ok(tactus_action_waypoints(action, rows.data(), count, &count));
  return rows;
}

/// An observation that points into `joints`.
inline tactus_observation observation(std::vector<double>& joints, bool contact = false) {
  return {sizeof(tactus_observation), contact ? 1 : 0, joints.size(), joints.data()};
}

inline std::vector<std::uint8_t> saved(const tactus_belief* belief) {
  std::size_t count = 0;
  expect_ok(tactus_belief_save(belief, nullptr, 0, &count));
  std::vector<std::uint8_t> bytes(count);
  expect_ok(tactus_belief_save(belief, bytes.data(), bytes.size(), &count));
  return bytes;
}

}  // namespace shelf
