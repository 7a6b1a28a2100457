// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "robot/kinematics.hpp"

namespace tactus::motion {

using geometry::Pose;
using robot::JointVector;

/// A joint path q_1 .. q_n. Between neighbours no point of the robot moves more than the step it was made with.
using JointPath = std::vector<JointVector>;

/// How fast the tool may go on a stretch of the path.
struct Pace {
  double speed = 0.1;               ///< of the tool frame, m/s
  double acceleration = 0.5;        ///< of the tool frame, m/s^2
  double joint_acceleration = 4.0;  ///< rad/s^2 or m/s^2
};

/// From waypoint `first` on, `pace` holds; the next segment begins where the next one's `first` says.
struct PacedSegment {
  std::size_t first = 0;
  Pace pace;
};

/// Seconds from the start at which each waypoint is passed: starts and ends at rest, within the joints' velocity limits
/// and the given accelerations and tool speeds. Same length as the path; strictly increasing where waypoints differ.
std::vector<double> time_path(const robot::RobotModel& model, int tool_link, const JointPath& path,
                              const std::vector<PacedSegment>& segments);

/// Length of the tool frame's way (m) and the angle it turns (rad).
struct ToolTravel {
  double metres = 0.0;
  double radians = 0.0;
};
ToolTravel tool_travel(const robot::RobotModel& model, int tool_link, const JointPath& path);

}  // namespace tactus::motion
