// SPDX-License-Identifier: BSD-3-Clause
#include "action/action.hpp"

#include <bit>

#include "support/rng.hpp"

namespace tactus::action {

std::uint64_t path_id(const JointPath& path) {
  std::uint64_t id = support::mix(path.size());
  for (const JointVector& q : path)
    for (const double value : q) id = support::mix(id ^ std::bit_cast<std::uint64_t>(value));
  return id;
}

Action make_action(const Task& task, Kind kind, JointPath path, std::size_t lead,
                   const std::vector<motion::PacedSegment>& pace) {
  const scene::Scene& scene = task.scene();
  Action action;
  action.kind = kind;
  action.id = path_id(path);
  action.times = motion::time_path(*scene.robot, scene.tool_link, path, pace);
  const motion::ToolTravel travel = motion::tool_travel(*scene.robot, scene.tool_link, path);
  action.length = travel.metres;
  action.full_cost = task.cost(travel) + task.options().cost.action;
  action.bodies = BodyPath(task.bodies(), path);
  action.lead = lead;
  action.sensing = task.options().sensing;
  action.path = std::move(path);
  return action;
}

}  // namespace tactus::action
