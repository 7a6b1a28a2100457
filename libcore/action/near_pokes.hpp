// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/motion.hpp"
#include "support/cancellation.hpp"

namespace tactus::action {

/// How far a near poke goes back before it goes aside, m.
inline constexpr double near_back = 0.03;

/// Pokes beside where the tool is, from `q`: `near_back` back, aside along an axis of the search frame, and straight
/// in, farther than it was. Not anchored: what the tool meets on the way there tells as much. A robot that has met the
/// target feels for its edges with them, where a probe would have it go to the retreat plane and back. What the known
/// world or the limits block before the tool is in again is left out; if they block it then, it goes as far as is free.
/// Throws `Cancelled`.
std::vector<MotionPtr> near_pokes(const Task& task, const JointVector& q,
                                  const support::Cancellation& cancellation = {});

}  // namespace tactus::action
