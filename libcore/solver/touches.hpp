// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "belief/trace.hpp"
#include "solver/problem.hpp"

namespace tactus::solver {

/// Where the tool was when it was stopped by a contact, and the way by which it came.
struct Touch {
  geometry::Pose base_from_tool;
  Eigen::Matrix<double, 6, 1> way;  ///< the last step: a unit vector, turns taken as what they shift at the tool's size
};

/// Between two waypoints. None if the tool did not move.
std::optional<Touch> touch_between(const contact::BodyPath& bodies, std::size_t from, std::size_t to);

/// What a trace ended in; none without contact.
std::optional<Touch> touch_of(const belief::Trace& trace);

/// Nearly the same place by nearly the same way: the second says little that the first did not.
bool alike(const Touch& a, const Touch& b);

/// The probability with which a motion ends in a touch that is like one of these.
double share_alike(const Choice& choice, const std::vector<Touch>& touches);

}  // namespace tactus::solver
