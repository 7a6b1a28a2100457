// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/body_path.hpp"
#include "geometry/voxel_grid.hpp"
#include "support/bitset.hpp"

namespace tactus::contact {

using geometry::VoxelGrid;
using support::Bitset;

/// The voxels of a grid that a motion enters, in the order in which it does.
///
/// V(q_1, q_i) of the paper is the first `entered_by(i)` entries; S(q_i, a), counted as the planning notes ask for
/// (what a no-contact outcome would remove), is the entries from `entered_by(i - 1)` on. A voxel is entered when its
/// centre lies inside the robot's solid.
struct SweptVoxels {
  std::vector<std::uint32_t> voxels;
  std::vector<std::uint32_t> entered;  ///< by waypoint: how many of `voxels` have been entered up to and including it

  std::size_t entered_by(std::size_t waypoint) const { return entered[waypoint]; }
};

SweptVoxels swept_voxels(const RobotBodies& bodies, const BodyPath& path, const VoxelGrid& grid);

/// Voxels that may hold the point of a contact at waypoint `stop` after the robot was free at `stop - 1`: centres
/// within half a diagonal and `slack` of the surface at the stop, and not deeper than that inside the robot before it.
/// One of the points of their cubes is touched. (The set S that U is measured from.)
Bitset contact_candidates(const RobotBodies& bodies, const BodyPath& path, std::size_t stop, const VoxelGrid& grid,
                          double slack);

/// The distance from every voxel's centre to the nearest centre in `from`, in metres (exact, separable); 1e30
/// everywhere if `from` is empty. O(voxels).
std::vector<float> distance_to(const Bitset& from, const VoxelGrid& grid);

}  // namespace tactus::contact
