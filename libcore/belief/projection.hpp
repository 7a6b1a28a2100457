// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "belief/trace.hpp"
#include "support/cancellation.hpp"

namespace tactus::belief {

using geometry::PoseVector;

/// A pose brought towards agreement with a history.
struct Projection {
  PoseVector pose{};
  double miss = 0.0;  ///< m by which contacts and clearances of the history are off; 0: it reproduces all of it
  bool exact() const { return miss == 0.0; }
};

/// A pose near `seed`, inside the prior: Gauss-Newton steps in the prior's free dimensions bring the target into touch
/// with the robot at every contact of these traces, and out of the way where it was free, until the pose reproduces the
/// whole history, or nothing is gained any more. The nearest on the way; none if that is off by more than `near` (m).
/// Throws `Cancelled`.
std::optional<Projection> projected(const Task& task, const std::vector<const Trace*>& history, const PoseVector& seed,
                                    double near, const support::Cancellation& cancellation = {});

/// The same of a history's traces that are not doubted.
std::optional<Projection> projected(const Task& task, const std::vector<Trace>& history, const PoseVector& seed,
                                    double near, const support::Cancellation& cancellation = {});

}  // namespace tactus::belief
