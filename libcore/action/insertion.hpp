// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "action/motion.hpp"
#include "support/cancellation.hpp"

namespace tactus::action {

/// The insertion attempt at a target supposed at `base_from_target`: from a retreat plane along the approach axis to
/// one of its seats, in finer steps and slower over the last `approach_depth`. An ordinary guarded motion. `plane`: its
/// height in the search frame, that of the whole region if there is none. Null if the arm can't follow it.
/// Throws `Cancelled`.
MotionPtr insertion(const Task& task, const Pose& base_from_target, const JointVector& near, std::size_t seat = 0,
                    std::optional<double> plane = std::nullopt, const support::Cancellation& cancellation = {});

/// The same from where the tool is at `q`: back along the approach axis until it is `approach_depth` before the seat, a
/// centimetre at least, straight across, and in. Not anchored: what it meets on the way tells as much. A robot that
/// nearly knows where the target is need not go to the retreat plane and back for each attempt. Throws `Cancelled`.
MotionPtr near_insertion(const Task& task, const Pose& base_from_target, const JointVector& q, std::size_t seat = 0,
                         const support::Cancellation& cancellation = {});

/// What `near_insertion` costs all the way, without the fixed part. `axis`: the approach axis in the base frame.
double near_insertion_cost(const Task& task, const Pose& base_from_tool, const Pose& base_from_seated,
                           const Vector3& axis);

}  // namespace tactus::action
