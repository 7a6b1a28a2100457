// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenario/scenario.hpp"
#include "tactus/scenario.h"

namespace tactus::capi {

/// A rigid body as somebody who draws the scene wants it.
struct DrawnBody {
  std::string name;
  tactus_body_kind kind;
  geometry::Mesh mesh;  ///< in the body's frame
  int link = -1;        ///< that carries it (robot and tool)
};

/// Links with a shape, from the base to the tip; the tool; the static world; the target.
std::vector<DrawnBody> drawn_bodies(const scenario::Scenario& scenario);

/// Pose of each body in the base frame, in the same order.
std::vector<geometry::Pose> body_poses(const std::vector<DrawnBody>& bodies, const robot::RobotModel& robot,
                                       const robot::JointVector& q, const geometry::Pose& base_from_target);

}  // namespace tactus::capi
