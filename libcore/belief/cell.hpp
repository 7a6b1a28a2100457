// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <numeric>

#include "geometry/pose.hpp"

namespace tactus::belief {

using geometry::PoseVector;

/// A box of poses about a centre; each split halves one dimension.
struct Cell {
  PoseVector centre{};
  std::array<std::uint8_t, 6> splits{};
  double bits = 0.0;  ///< by which the history is less likely from here than from where it is likeliest, where
                      ///< observations may err; else 0
  std::size_t all_splits() const { return std::accumulate(splits.begin(), splits.end(), std::size_t{0}); }
  bool operator==(const Cell& other) const = default;
};

/// Of a cell, in all dimensions together: no more are made, nor restored.
inline constexpr std::size_t most_splits = 120;

/// A cell so much less likely than the likeliest counts neither for extents nor for modes.
inline constexpr double negligible_bits = 10.0;

/// What the splits of cells refer to.
struct CellFrame {
  PoseVector half{};   ///< of the widths of a cell that was not split
  double reach = 0.0;  ///< m from the target's origin to its farthest vertex

  PoseVector half_width(const Cell& cell) const;
  double radius(const Cell& cell) const;  ///< m that a point of the target may be off the cell's centre
  double volume(const Cell& cell) const;  ///< product of the free dimensions' widths

  /// The dimension that moves the target's points most: that in which a cell is halved. It depends on the splits alone.
  int widest(const Cell& cell) const;
  std::array<Cell, 2> halves(const Cell& cell) const;  ///< the lower one first
};

}  // namespace tactus::belief
