// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/motion.hpp"

namespace tactus::action {

/// What the robot executes, guarded: a joint path from its present configuration, with times. Const, shared between
/// planner, belief and caller.
struct Action {
  std::uint64_t id = 0;  ///< of the path: equal paths have equal ids
  Kind kind = Kind::move;
  JointPath path;
  std::vector<double> times;  ///< s, by waypoint
  BodyPath bodies;
  std::size_t lead = 0;              ///< waypoints before the motion proper: the way over the retreat plane
  double length = 0.0;               ///< m that the tool frame goes if nothing is touched
  double full_cost = 0.0;            ///< of going all the way
  double expected_cost = 0.0;        ///< of it and all that follows, as the planner saw it
  double contact_probability = 0.0;  ///< as the planner saw it
  Sensing sensing;                   ///< what is taken for possible of the robot, and decides where its contact may be
  Pose supposed_target = Pose::Identity();
};

using ActionPtr = std::shared_ptr<const Action>;

/// A hash of the waypoints: the identity of an action.
std::uint64_t path_id(const JointPath& path);

/// An action along `path` with everything that follows from it.
Action make_action(const Task& task, Kind kind, JointPath path, std::size_t lead,
                   const std::vector<motion::PacedSegment>& pace);

}  // namespace tactus::action
