// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "belief/trace.hpp"

namespace tactus::belief {

using geometry::PoseVector;

/// A pose near `seed`, inside the prior, that reproduces the whole history exactly: Gauss-Newton steps in the prior's free dimensions bring the target into touch with the robot at every
/// recorded contact, and out of the way where it was free. None if that does not succeed within a few steps.
std::optional<Pose> projected(const Task& task, const std::vector<Trace>& history, PoseVector seed);

}  // namespace tactus::belief
