// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "robot/model.hpp"

namespace tactus::contact {

/// The pairs of links with shapes that could collide with each other, first < second, ascending. Left out are links
/// rigidly connected to each other, adjacent ones, and pairs that the SRDF disables. Adjacent are two links that one
/// moving joint connects, looking through links without shapes that are fixed to either; behind two joints the pair is
/// checked, whatever stands between.
std::vector<robot::LinkPair> collidable_pairs(const robot::RobotModel& model);

/// For each link, whether a joint moves it against the root.
std::vector<bool> moving_links(const robot::RobotModel& model);

}  // namespace tactus::contact
