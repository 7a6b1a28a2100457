// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "belief/trace.hpp"

namespace tactus::belief {

using geometry::PoseVector;

/// A pose brought towards agreement with a history.
struct Projection {
  PoseVector pose{};
  bool exact = false;  ///< it reproduces the whole history; else it comes near that
};

/// A pose near `seed`, inside the prior: Gauss-Newton steps in the prior's free dimensions bring the target into touch
/// with the robot at every contact of these traces, and out of the way where it was free, until the pose reproduces the
/// whole history or the steps are used up. None if it is still off by more than `near` (m) then.
std::optional<Projection> projected(const Task& task, const std::vector<const Trace*>& history, const PoseVector& seed,
                                    double near);

/// The same of a history's traces that are not doubted.
std::optional<Projection> projected(const Task& task, const std::vector<Trace>& history, const PoseVector& seed,
                                    double near);

}  // namespace tactus::belief
