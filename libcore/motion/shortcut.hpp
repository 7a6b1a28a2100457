// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/known_world.hpp"
#include "motion/path.hpp"
#include "support/deadline.hpp"
#include "support/rng.hpp"

namespace tactus::motion {

/// A shorter path with the same ends: detours between random points of `corners` are replaced by straight lines in
/// joint space that are free at `step`. A fixed number of attempts; the deadline only cuts them short. Lines of the
/// given path that stay are not checked again. (OMPL's own simplifier draws from a generator of the process and may
/// return invalid paths.)
JointPath shortcut(const contact::KnownWorld& world, JointPath corners, double step, support::Rng& rng,
                   const support::Deadline& deadline);

}  // namespace tactus::motion
