// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/task.hpp"

namespace tactus::action {

enum class Kind : std::int32_t {
  move = 1,       ///< the tool moves along an axis of the search frame, from where it is
  turn = 2,       ///< the tool turns about the approach axis
  sweep = 3,      ///< from the retreat plane down beside the region, and through it sideways
  poke = 4,       ///< straight in, from the retreat plane or from beside where the tool is
  insertion = 5,  ///< from the retreat plane to the seated pose at a supposed target
};

/// A guarded motion of the search as the planner weighs it: a joint path, where the bodies are along it, and what it
/// costs to get that far. Anchored motions (sweep, poke, insertion) set out from the retreat plane; getting there is
/// added when they are chosen. Const, shared.
struct Motion {
  Kind kind = Kind::move;
  bool anchored = false;
  JointPath path;
  BodyPath bodies;
  std::vector<double> cost_to;  ///< by waypoint: of the tool's way from the first waypoint, without the fixed part
  std::vector<motion::PacedSegment> pace;
  Pose base_from_start = Pose::Identity();  ///< of the tool
  Pose supposed_target = Pose::Identity();  ///< insertion: the target pose it was made for
};

using MotionPtr = std::shared_ptr<const Motion>;

/// Fills `bodies`, `cost_to` and `base_from_start` from the path; a motion without a pace goes at the approach speed.
MotionPtr finished(const Task& task, Motion motion);

/// The first `waypoints` of a motion.
MotionPtr truncated(const Task& task, const Motion& motion, std::size_t waypoints);

/// `then` put behind `first`, whose last waypoint it begins with; the joint is written once.
JointPath joined(JointPath first, const JointPath& then);

/// What it costs to take the tool from one pose to another over the retreat plane: straight back, across, and to the
/// start. No free path is looked for.
double transit_cost(const Task& task, const Pose& base_from_tool, const Pose& base_from_start);

}  // namespace tactus::action
