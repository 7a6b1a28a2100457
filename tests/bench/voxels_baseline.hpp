// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/voxels.hpp"

/// What voxels cost voxel by voxel, in double precision: the same answers.
namespace tactus::bench::plain {

using contact::Bitset;
using contact::BodyPath;
using contact::RobotBodies;
using contact::SweptVoxels;
using contact::VoxelGrid;

/// Without the sparse words.
SweptVoxels swept_voxels(const RobotBodies& bodies, const BodyPath& path, const VoxelGrid& grid);

std::vector<std::uint32_t> entered_of(const SweptVoxels& swept, const Bitset& set);

/// By the lower envelope of parabolas, line by line.
std::vector<float> distance_to(const Bitset& from, const VoxelGrid& grid);

/// PO \ U for the first contact of a belief, to a fixed point.
Bitset after_contact(const belief::VoxelModel& model, Bitset possibly_occupied, Bitset candidates);

}  // namespace tactus::bench::plain
