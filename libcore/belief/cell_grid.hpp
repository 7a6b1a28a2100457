// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include "belief/claim.hpp"
#include "support/bitset.hpp"

namespace tactus::belief {

using geometry::PoseVector;
using support::Bitset;

class CellTables;

/// How a prior is cut evenly into cells of poses: x, y, z, roll, pitch, yaw.
struct CellShape {
  PoseVector corner{};  ///< the prior's lowest
  PoseVector half{};    ///< of every cell's widths
  std::array<int, 6> count{};
  bool operator==(const CellShape&) const = default;

  std::size_t cells() const;

  /// The dimensions in the order in which cells are counted, that of neighbours last: the turns first, then the
  /// positions, with the two of most cells at the end.
  std::array<int, 6> order() const;
};

/// Cells that are at most `position` m and `angle` rad wide, and cover the prior exactly. Where that would make more
/// than `most` of them, both are widened alike.
CellShape cell_shape(const scene::Prior& prior, double position, double angle, std::size_t most);

/// Cells of poses, each of which may hold the truth or not: a bit a cell, so that tens of millions take a few MiB. A
/// value.
class CellGrid {
 public:
  /// `reach`: m from the target's origin to its farthest vertex.
  CellGrid(const CellShape& shape, double reach);

  std::size_t size() const { return left_; }  ///< cells that may hold the truth
  const CellShape& shape() const { return shape_; }
  const PoseVector& half_width() const { return shape_.half; }  ///< of every cell
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
  /// edge of that). What `tables` of cells of this shape tell is not asked. `threads` as in `support::for_ranges`; the
  /// same cells are left whatever their number.
  void sift(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes = {},
            const CellTables* tables = nullptr, int threads = 1);

 private:
  struct Box {
    std::array<int, 6> low{}, high{};  ///< cells low .. high - 1
  };
  struct Part {
    Box box;
    std::vector<Claim> claims;  ///< that not all of its cells are known to be left by
  };
  class Sieve;
  template <typename Row>
  void for_each_row(const Box& box, Row&& row) const;
  void sift(const Task& task, Part whole, const Excludes& excludes, int threads);
  bool any_in(const Box& box) const;
  bool any_near(const PoseVector& v, double tolerance) const;
  void drop(const Box& box);

  CellShape shape_;
  std::array<int, 6> order_;
  double reach_;
  Bitset members_;  ///< counted by `order_`
  std::size_t left_ = 0;
};

}  // namespace tactus::belief
