// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "belief/trace.hpp"
#include "support/bitset.hpp"

namespace tactus::belief {

using geometry::PoseVector;
using support::Bitset;

/// A prior cut evenly into cells of poses, each of which may hold the truth or not: a bit a cell, so that tens of
/// millions take a few MiB. A value.
class CellGrid {
 public:
  /// Cells that are at most `position` m and `angle` rad wide, and cover the prior exactly. Where that would make more
  /// than `most` of them, both are widened alike. `reach`: m from the target's origin to its farthest vertex.
  CellGrid(const scene::Prior& prior, double position, double angle, std::size_t most, double reach);

  std::size_t size() const { return left_; }  ///< cells that may hold the truth
  const std::array<int, 6>& count() const { return count_; }
  const PoseVector& half_width() const { return half_; }  ///< of every cell
  const Bitset& members() const { return members_; }
  void assign(Bitset members);  ///< of `members().size()`

  PoseVector centre(std::size_t member) const;

  /// Whether a cell that may hold the truth has a pose within `tolerance` (m and rad) of this one, in whichever way
  /// roll, pitch and yaw describe it.
  bool holds(const Pose& base_from_target, double tolerance) const;

  /// Whether no pose within `radius` of this one (as in `fit`) may be the truth, by what else is known.
  using Excludes = std::function<bool(const Pose& base_from_target, double radius)>;

  /// Drops the cells in which no pose can have given every trace, or that `excludes` says so of. Asks boxes of cells
  /// before cells: what a motion comes nowhere near, and what it sweeps through, is decided as a whole. O(cells at the
  /// edge of that).
  void sift(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes = {});

 private:
  struct Box {
    std::array<int, 6> low{}, high{};  ///< cells low .. high - 1
  };
  struct Claim {
    const Trace* trace;
    std::size_t from;  ///< no pose of the box is touched before this waypoint
  };
  class Sieve;
  template <typename Row>
  void for_each_row(const Box& box, Row&& row) const;
  bool any_in(const Box& box) const;
  bool any_near(const PoseVector& v, double tolerance) const;
  void drop(const Box& box);

  PoseVector corner_{};  ///< the prior's lowest
  PoseVector half_{};
  std::array<int, 6> count_{};
  int row_ = 5;  ///< the last dimension with more than one cell: neighbours along it are neighbours in `members_`
  double reach_;
  Bitset members_;  ///< yaw fastest, then pitch, roll, z, y, x
  std::size_t left_ = 0;
};

}  // namespace tactus::belief
