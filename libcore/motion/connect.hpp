// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "contact/known_world.hpp"
#include "motion/path.hpp"
#include "support/deadline.hpp"

namespace tactus::motion {

/// `path` with waypoints put in until no point of the robot moves more than `step` metres between neighbours
/// (joint-linear between the given ones).
JointPath densified(const contact::KnownWorld& world, const JointPath& path, double step);

/// Every waypoint free, at the resolution the path has.
bool is_free(const contact::KnownWorld& world, const JointPath& path);

/// The straight line in joint space, densified, if it is free.
std::optional<JointPath> straight_joint_path(const contact::KnownWorld& world, const JointVector& from,
                                             const JointVector& to, double step);

struct StraightOptions {
  double step = 0.004;          ///< m that no point of the robot exceeds between waypoints
  double stride = 0.0;          ///< m: of the tool between waypoints, or multiples of it, where the step allows; 0: any
  bool keep_free_part = false;  ///< of a way that is blocked: at least two waypoints from the start
  support::Cancellation cancellation{};
};

/// The straight line of the tool link in space (slerp in rotation), ending at the goal within 1e-6 m and rad, followed
/// by inverse kinematics from `from` without jumping to another branch, densified, if it is free and inside the limits
/// all along. Throws `Cancelled`.
std::optional<JointPath> straight_tool_path(const contact::KnownWorld& world, int tool_link, const JointVector& from,
                                            const Pose& base_from_tool_goal, const StraightOptions& options);

struct ConnectOptions {
  double step = 0.004;    ///< m
  int iterations = 2000;  ///< of RRTConnect; counted, so that the answer is the same on every machine
  std::uint64_t seed = 1;
};

/// A free path between two free configurations: the straight joint path if free, else RRTConnect, simplified and
/// validated again at `step`. [OMPL] None if an end is not free, or if nothing was found within the iterations or the
/// deadline. Deterministic but for the deadline, whatever the process asked before and in whatever thread. Joints go
/// from value to value: a continuous one takes no shorter way through a whole turn. Any thread.
std::optional<JointPath> connect(const contact::KnownWorld& world, const JointVector& from, const JointVector& to,
                                 const ConnectOptions& options, const support::Deadline& deadline);

}  // namespace tactus::motion
