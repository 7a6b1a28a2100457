// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/belief.hpp"

namespace tactus::solver {

/// What a belief expects of an action from where the robot is: by waypoint the probability that the first contact is
/// there, and last that there is none; sums to one. On voxels by either likelihood, whichever the belief's model names;
/// on poses the share of those that are drawn for planning.
std::vector<double> forecast(const belief::Belief& belief, const action::Action& action, belief::Likelihood likelihood,
                             support::Rng& rng);

}  // namespace tactus::solver
