// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "robot/model.hpp"

namespace tactus::robot {

/// The link pairs that an SRDF's `<disable_collisions>` elements name: sorted, each once. Throws what `load_model`
/// does.
std::vector<LinkPair> read_disabled_pairs(const std::filesystem::path& srdf, const RobotModel& model);

}  // namespace tactus::robot
