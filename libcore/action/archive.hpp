// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "action/action.hpp"
#include "support/bytes.hpp"

namespace tactus::action {

/// The action as bytes, versioned and with a checksum.
std::vector<std::uint8_t> save(const Task& task, const Action& action);

/// The action that was saved; `id` and `bodies` follow from its path. Throws `bad_saved_state`, naming what is wrong,
/// for bytes that are none of `save`'s, and `wrong_scenario` for an action of another target, tool, robot or world: its
/// path was found free of another world.
Action restore(const Task& task, const std::uint8_t* bytes, std::size_t size);

// Parts of other saved things.

void write_joints(support::ByteWriter& to, const JointVector& q);
void write_path(support::ByteWriter& to, const JointPath& path);
void write_sensing(support::ByteWriter& to, const Sensing& sensing);

JointVector read_joints(support::ByteReader& from, int dof, const char* field);  ///< finite
JointPath read_path(support::ByteReader& from, int dof, std::size_t least,
                    const char* field);  ///< of `least` (>= 1) or more waypoints
Kind read_kind(support::ByteReader& from, const char* field);
Sensing read_sensing(support::ByteReader& from, const char* field);

}  // namespace tactus::action
