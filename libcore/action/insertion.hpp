// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/motion.hpp"

namespace tactus::action {

/// The insertion attempt at a target supposed at `base_from_target`: from the retreat plane along the approach axis to
/// one of its seats, in finer steps and slower over the last `approach_depth`. An ordinary guarded motion. Null if the
/// arm can't follow it.
MotionPtr insertion(const Task& task, const Pose& base_from_target, const JointVector& near, std::size_t seat = 0);

}  // namespace tactus::action
