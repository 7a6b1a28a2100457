// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "geometry/pose.hpp"
#include "support/bitset.hpp"

namespace tactus::contact {

using geometry::Pose;
using geometry::Vector3;
using support::Bitset;

/// A pose in whole numbers: steps along the lattice's x, y and z, and which of its turns.
struct LatticePose {
  std::array<int, 3> at{};
  int turn = 0;
  bool operator==(const LatticePose&) const = default;
};

/// The way of a tool on a lattice, waypoint by waypoint.
using LatticeMotion = std::vector<LatticePose>;

/// Poses of the target and of the tool that differ by whole steps, so that what is known of one pair is known of every
/// pair with the same offset and the same turns. The tool's steps may be finer than the target's by a whole number, its
/// `parts`. A value.
///
/// A set of target poses (cells) is a `Bitset` of `bits()`: x fastest, each row of x filled up to whole words of 64,
/// then y, z and the turn. What fills up is never a member.
struct Lattice {
  Pose base_from_lattice = Pose::Identity();
  Vector3 pitch = Vector3::Constant(0.002);  ///< m, of the target's steps along x, y, z
  int parts = 1;                             ///< the tool's steps are the pitch divided by this
  std::array<int, 3> count{1, 1, 1};         ///< target positions are 0 .. count - 1 along x, y, z
  std::vector<Eigen::Matrix3d> target_turns{Eigen::Matrix3d::Identity()};  ///< lattice_from_target
  std::vector<Eigen::Matrix3d> tool_turns{Eigen::Matrix3d::Identity()};    ///< lattice_from_tool

  std::size_t cells() const;
  std::size_t row_words() const { return (static_cast<std::size_t>(count[0]) + 63) / 64; }
  std::size_t rows() const { return static_cast<std::size_t>(count[1]) * count[2] * target_turns.size(); }
  std::size_t bits() const { return 64 * row_words() * rows(); }

  std::size_t index(const LatticePose& target) const;
  LatticePose cell(std::size_t index) const;
  Bitset all() const;  ///< every cell

  Pose base_from_target(const LatticePose& target) const;
  Pose base_from_tool(const LatticePose& tool) const;

  /// How the tool stands among the target's positions: on or past the one at `at`, in the way number `way`, of turn and
  /// parts past it. Tools that stand in the same way see the same.
  struct Stand {
    std::array<int, 3> at{};
    int way = 0;
    bool operator==(const Stand&) const = default;
  };
  Stand stand(const LatticePose& tool) const;
  int ways() const { return static_cast<int>(tool_turns.size()) * parts * parts * parts; }
  int turn_of(int way) const { return way / (parts * parts * parts); }
  Vector3 past(int way) const;  ///< m, of a tool that stands in this way, past the target's position

  /// Where a target that is `offset` steps from where the tool stands sees the tool.
  Pose target_from_tool(const std::array<int, 3>& offset, int target_turn, int way) const;
};

}  // namespace tactus::contact
