// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "motion/connect.hpp"

namespace tactus::motion {

/// The corners of a path from `from` to `to` (both free) found by RRTConnect: the straight lines between them are free
/// at `options.step`. Everything random comes from `options.seed`; OMPL's own messages go to the log. [OMPL]
std::optional<JointPath> rrt_connect(const contact::KnownWorld& world, const JointVector& from, const JointVector& to,
                                     const ConnectOptions& options, const support::Deadline& deadline);

}  // namespace tactus::motion
