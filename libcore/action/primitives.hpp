// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/motion.hpp"
#include "support/cancellation.hpp"

namespace tactus::action {

/// Guarded moves of the tool along the axes of the search frame and turns about its approach axis, at the lengths and
/// angles of the options, from `q`. What is blocked by the known world or the limits is as long as it is free; motions
/// of fewer than two waypoints are left out. Motions along one ray are prefixes of one another.
/// Throws `Cancelled`.
std::vector<MotionPtr> primitives(const Task& task, const JointVector& q,
                                  const support::Cancellation& cancellation = {});

}  // namespace tactus::action
