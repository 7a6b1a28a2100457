// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/instance.hpp"

namespace tactus::solver {

/// An instance as text that public solvers read: costs are negative rewards, the goal is absorbing at reward 0, and a
/// motion that can't be made leaves the robot where it is at `blocked_cost`, so that nothing is free but the goal.

/// The largest cost of any motion.
double blocked_cost(const Instance& instance);

/// PomdpX, version 1.0: two state variables, the robot (fully observed, so that there is no other observation) and the
/// pose. Of the transitions only those that occur are listed.
std::string pomdpx(const Instance& instance);

/// Cassandra's format: the states are the pairs of a configuration and a pose that can come about, and the goal; what
/// is observed is the configuration.
std::string pomdp(const Instance& instance);

}  // namespace tactus::solver
