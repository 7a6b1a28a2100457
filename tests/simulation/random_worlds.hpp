// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "belief/small_task.hpp"
#include "contact/reference.hpp"
#include "simulation/world.hpp"
#include "support/error.hpp"

/// Worlds of the small task, random actions in them, and a robot that is written plainly.
namespace tactus::test {

using belief::Kind;
using belief::Observation;
using simulation::World;
using support::Rng;
using support::Status;
using Model = std::shared_ptr<const belief::Model>;

inline const Model& model() {
  static const auto made = small_model(Kind::particles, {.roll_width = 0.2, .position_width = 0.04, .most_cells = 200});
  return made;
}

inline JointVector substep(const motion::JointPath& path, std::size_t i, int k) {
  return k == 10 ? path[i] : JointVector(path[i - 1] + k / 10.0 * (path[i] - path[i - 1]));
}

/// Where a robot stops that looks about every tenth of the way from waypoint to waypoint.
inline Observation plain_stop(const action::Task& task, const Pose& truth, const action::Action& action) {
  const reference::Shape shape{{task.scene().target.mesh}, {}};
  const reference::Placed target(shape, truth);
  std::vector<reference::Part> parts{{task.scene().tool_link, {tool_pieces(), {}}}};
  const auto& links = task.scene().robot->links;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (!links[i].shapes.empty()) parts.push_back({static_cast<int>(i), {links[i].shapes, {}}});
  for (std::size_t i = 1; i < action.path.size(); ++i)
    for (int k = 1; k <= 10; ++k) {
      const JointVector q = substep(action.path, i, k);
      if (reference::touches(reference::track(*task.scene().robot, parts, {q}).front(), target, 0.0)) return {true, q};
    }
  return {false, action.path.back()};
}

/// Random actions in worlds with random truths; `visit(world, action, seen)` after each.
template <typename Visit>
void for_random_actions(const Model& m, std::uint64_t seed, int episodes, Visit&& visit) {
  Rng rng(seed);
  for (int episode = 0; episode < episodes; ++episode) {
    World world(m, m->task->scene().prior.sample(rng));
    action::ActionLibrary library(*m->task);
    for (int i = 0; i < 4; ++i) {
      const action::Action action = random_action(*m->task, library, world.configuration(), rng);
      const Observation seen = world.execute(action);
      ASSERT_NO_FATAL_FAILURE(visit(world, action, seen));
    }
  }
}

}  // namespace tactus::test
