// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "boundary.hpp"
#include "drawing.hpp"
#include "scenario/scenario.hpp"
#include "simulation/world.hpp"
#include "solver/instance.hpp"
#include "tactus/tactus.h"

/// What the opaque handles of the C ABI hold. All but the scenario keep the scenario's contents alive.

using ScenarioPtr = std::shared_ptr<const tactus::scenario::Scenario>;

struct tactus_scenario {
  explicit tactus_scenario(ScenarioPtr s) : contents(std::move(s)), bodies(tactus::capi::drawn_bodies(*contents)) {}

  ScenarioPtr contents;
  std::vector<tactus::capi::DrawnBody> bodies;
  const tactus::scene::Scene& scene() const { return contents->task->scene(); }
};

struct tactus_action {
  ScenarioPtr scenario;
  tactus::action::ActionPtr action;
};

struct tactus_belief {
  tactus_belief(ScenarioPtr s, tactus::belief::Belief b) : scenario(std::move(s)), belief(std::move(b)) {}

  ScenarioPtr scenario;
  tactus::belief::Belief belief;
  mutable std::atomic<bool> in_use{false};
};

struct tactus_planner {
  tactus_planner(ScenarioPtr s, const tactus::solver::PlannerOptions& options)
      : scenario(std::move(s)), planner(scenario->model, options) {}

  ScenarioPtr scenario;
  tactus::solver::Planner planner;
  mutable std::atomic<bool> in_use{false};
};

struct tactus_world {
  tactus_world(ScenarioPtr s, const tactus::geometry::Pose& base_from_target,
               const tactus::simulation::WorldOptions& options)
      : scenario(std::move(s)), world(scenario->model, base_from_target, options) {}

  ScenarioPtr scenario;
  tactus::simulation::World world;
  mutable std::atomic<bool> in_use{false};
};

struct tactus_instance {
  ScenarioPtr scenario;
  tactus::solver::InstancePtr instance;
};

namespace tactus::capi {

inline int dof(const ScenarioPtr& scenario) { return scenario->task->scene().robot->dof(); }

/// Throws `wrong_scenario` unless both were made from the same scenario handle.
inline void check_same(const ScenarioPtr& expected, const ScenarioPtr& found, const char* argument) {
  if (expected != found)
    throw Error(Status::wrong_scenario,
                std::string(argument) + ": found one of scenario '" + found->description.name +
                    "', expected one made from the same tactus_scenario as the object it is given to");
}

/// What a `tactus_observation` says, checked.
belief::Observation observation_from(const tactus_observation* observation, int dof);

/// What the caller asks for, checked; `defaults` where it does not say, or for NULL.
solver::PlannerOptions planner_options(const tactus_planner_options* options, const solver::PlannerOptions& defaults);

}  // namespace tactus::capi
