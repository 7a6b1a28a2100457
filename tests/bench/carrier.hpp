// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "robot/kinematics.hpp"

namespace tactus::bench {

using geometry::Pose;
using robot::JointVector;

/// A tool's way: straight in position, evenly turning. Poses of the tool link, in a frame of the motions.
struct ToolMotion {
  Pose from, to;
};

/// What carries the tool: a robot, and how it follows a tool's way.
struct Carrier {
  std::shared_ptr<const robot::RobotModel> model;
  int tool_link = 0;
  Pose base_from_motions = Pose::Identity();
  /// The motions in turn, each with `n` waypoints after its start.
  std::function<std::vector<std::vector<JointVector>>(const Carrier&, const std::vector<ToolMotion>&, std::size_t n)>
      follow;
};

/// Three slides and three turns without shapes: the tool flies where it likes.
Carrier free_flyer();

/// The UR10e of the shelf, the motions in front of the shelf's back wall. Every other motion is made straight in joint
/// space instead, between the same ends.
Carrier shelf_arm();

}  // namespace tactus::bench
