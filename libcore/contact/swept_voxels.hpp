// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "contact/body_path.hpp"
#include "contact/kernel/sets.hpp"
#include "contact/kernel/voxels.hpp"
#include "geometry/voxel_grid.hpp"
#include "support/bitset.hpp"

namespace tactus::contact {

using geometry::VoxelGrid;
using support::Bitset;

/// The voxels of a grid that a motion enters, in the order in which it does.
///
/// V(q_1, q_i) of the paper is the first `entered_by(i)` entries; S(q_i, a), counted as the planning notes ask for
/// (what a no-contact outcome would remove), is the entries from `entered_by(i - 1)` on. A voxel is entered when its
/// centre lies inside the robot's solid. About 16 bytes a voxel.
struct SweptVoxels {
  std::vector<std::uint32_t> voxels;
  std::vector<std::uint32_t> entered;  ///< by waypoint: how many of `voxels` have been entered up to and including it

  /// The same voxels as sparse words of a bitset: S(q_i, a) is the words from `words_by[i - 1]` to `words_by[i]`.
  std::vector<std::uint32_t> word;      ///< index in the bitset
  std::vector<std::uint64_t> mask;      ///< members
  std::vector<std::uint32_t> words_by;  ///< by waypoint

  std::size_t entered_by(std::size_t waypoint) const { return entered[waypoint]; }
};

/// By signed-distance look-ups for sixteen voxels at a time; the triangles decide where these leave a centre open. A
/// block of voxels is looked up again when the body has travelled as far as the block was from it.
SweptVoxels swept_voxels(const RobotBodies& bodies, const BodyPath& path, const VoxelGrid& grid,
                         const kernel::VoxelKernel& kernel = kernel::fastest_voxel_kernel());

/// |S(q_i, a) n set| by waypoint. O(words swept), about 1 ns a word.
std::vector<std::uint32_t> entered_of(const SweptVoxels& swept, const Bitset& set,
                                      const kernel::SetKernel& kernel = kernel::fastest_set_kernel());

/// Voxels whose centres are more than `depth` (m) inside the robot at one of the first `waypoints`: what a robot that
/// may be off by as much has entered for sure. Each is looked at by itself at every waypoint.
Bitset voxels_deep_inside(const RobotBodies& bodies, const BodyPath& path, std::size_t waypoints, const VoxelGrid& grid,
                          double depth);

/// Voxels that may hold the point of a contact at waypoint `stop` after the robot was free at `stop - 1`: centres
/// within half a diagonal and `slack` of the surface at the stop, and not deeper than that inside the robot before it.
/// One of the points of their cubes is touched. (The set S that U is measured from.)
Bitset contact_candidates(const RobotBodies& bodies, const BodyPath& path, std::size_t stop, const VoxelGrid& grid,
                          double slack);

/// The distance from every voxel's centre to the nearest centre in `from`, in metres (exact, separable); 1e30
/// everywhere if `from` is empty. O(voxels) where all are near a member, at worst O(voxels x longest side).
std::vector<float> distance_to(const Bitset& from, const VoxelGrid& grid,
                               const kernel::VoxelKernel& kernel = kernel::fastest_voxel_kernel());

}  // namespace tactus::contact
