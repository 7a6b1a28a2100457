// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>

#include "belief/projection.hpp"

namespace tactus::belief {

using geometry::PoseVector;

/// A box of poses about a centre; each split halves one dimension.
struct Cell {
  PoseVector centre{};
  std::array<std::uint8_t, 6> splits{};
  bool operator==(const Cell&) const = default;
};

struct CellOptions {
  double position = 0.01;         ///< initial full width, m
  double angle = 0.1;             ///< initial full width, rad
  std::size_t most = 4000;        ///< cells are split while there are fewer than half of these
  double finest_radius = 0.0008;  ///< m: no cell with a smaller radius is split
};

/// Phase 2: a set of cells that covers every pose that may have given the observations. A cell goes only when no pose
/// in it can have. A value.
class CellBelief {
 public:
  /// All cells of the prior that `keep` says may hold the truth (pose of the centre, radius). The grid covers the prior
  /// exactly.
  CellBelief(const Task& task, const CellOptions& options, const std::function<bool(const Pose&, double)>& keep);

  const std::vector<Cell>& cells() const { return cells_; }
  PoseVector half_width(const Cell& cell) const;
  double radius(const Cell& cell) const;  ///< m that a point of the target may be off the cell's centre
  double volume(const Cell& cell) const;  ///< product of the free dimensions' widths

  /// Removes the cells that can't have given the trace. Returns whether any are left; if none would be, nothing is
  /// changed.
  bool update(const Task& task, const Trace& trace);

  /// Splits cells, the coarsest first, while they are few, and tests the new ones against the whole history. False (and
  /// unchanged from there on) if that would leave none. Stops early when `enough` says so.
  bool refine(const Task& task, const std::vector<Trace>& history,
              const std::function<bool(const CellBelief&)>& enough = {});

  /// A random pose of a cell drawn by volume, brought towards agreement with the history (see `projected`). None if
  /// that led nowhere.
  std::optional<Projection> draw(const Task& task, const std::vector<Trace>& history, support::Rng& rng) const;

  /// A cell's index, drawn by volume.
  std::size_t draw_cell(support::Rng& rng) const;

  static CellBelief restored(const Task& task, const CellOptions& options, std::vector<Cell> cells);

 private:
  CellBelief(const Task& task, const CellOptions& options);
  bool may_split(const Cell& cell) const { return radius(cell) > options_.finest_radius; }
  void split(const Cell& cell, std::vector<Cell>& halves) const;
  bool possible(const Task& task, const std::vector<Trace>& history, const Cell& cell) const;

  CellOptions options_;
  PoseVector initial_half_{};
  double reach_ = 0.0;  ///< m from the target's origin to its farthest vertex
  std::vector<Cell> cells_;
};

}  // namespace tactus::belief
