// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/belief.hpp"
#include "scenario/description.hpp"
#include "solver/planner.hpp"

namespace tactus::scenario {

/// A scenario made ready: meshes loaded, the robot checked, fields and the arm's posture computed. Const, shared by any
/// number of threads.
struct Scenario {
  Description description;
  std::shared_ptr<const action::Task> task;
  std::shared_ptr<const belief::Model> model;  ///< with the scenario's kind of belief
  solver::PlannerOptions planner;              ///< the scenario's defaults

  /// The same model with another kind of belief.
  std::shared_ptr<const belief::Model> model_of(belief::Kind kind) const;
};

/// Reads, checks and prepares. Throws `support::Error` with everything that is wrong.
std::shared_ptr<const Scenario> load(const std::filesystem::path& file);
std::shared_ptr<const Scenario> parse(const std::string& yaml, const std::filesystem::path& base_dir);

/// Everything wrong with a scenario, without throwing: mistakes in the file, in the robot and the meshes, a start in
/// collision, an unreachable prior, a prior that cuts into the known world.
std::vector<std::string> check(const std::filesystem::path& file);

}  // namespace tactus::scenario
