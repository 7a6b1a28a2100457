// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "action/motion.hpp"

namespace tactus::action {

/// The insertion attempt at a target supposed at `base_from_target`: from a retreat plane along the approach axis to
/// one of its seats, in finer steps and slower over the last `approach_depth`. An ordinary guarded motion. `plane`: its
/// height in the search frame, that of the whole region if there is none. Null if the arm can't follow it.
MotionPtr insertion(const Task& task, const Pose& base_from_target, const JointVector& near, std::size_t seat = 0,
                    std::optional<double> plane = std::nullopt);

}  // namespace tactus::action
