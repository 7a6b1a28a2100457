// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>

#include "belief/cell_grid.hpp"
#include "belief/projection.hpp"

namespace tactus::belief {

/// A box of poses about a centre; each split halves one dimension.
struct Cell {
  PoseVector centre{};
  std::array<std::uint8_t, 6> splits{};
  /// A bit for each of the first 64 traces of the history: no pose of the cell is touched where the robot was free.
  /// What need not be asked again; follows from the rest, and is not compared.
  std::uint64_t settled = 0;
  bool operator==(const Cell& other) const { return centre == other.centre && splits == other.splits; }
};

struct CellOptions {
  double position = 0.004;               ///< initial full width, m
  double angle = 0.06;                   ///< initial full width, rad
  std::size_t most = 20000;              ///< cells are split while there are fewer than these
  std::size_t most_at_first = 1u << 21;  ///< initial cells are widened until there are no more than these
  double finest_radius = 0.00025;        ///< m: no cell with a smaller radius is split
  int threads = 1;                       ///< that test cells; 0: as many as the machine has. The answers are the same
};

/// Phase 2: a set of cells that covers every pose that may have given the observations. A cell goes only when no pose
/// in it can have. As long as there are many they are those of a grid; then a list, in which they are split. They weigh
/// what the prior says: that counts where cells are drawn or described, and removes none. A value.
class CellBelief {
 public:
  using Excludes = CellGrid::Excludes;

  /// All cells of the prior.
  CellBelief(const Task& task, const CellOptions& options);

  std::size_t size() const { return grid_ ? grid_->size() : cells_.size(); }
  std::vector<Cell> cells() const;  ///< O(cells), as the two below
  template <typename Visit>
  void for_each(Visit&& visit) const;
  template <typename Test>
  bool all_of(Test&& test) const;

  PoseVector half_width(const Cell& cell) const;
  double radius(const Cell& cell) const;  ///< m that a point of the target may be off the cell's centre
  double coarsest() const;                ///< radius of the coarsest cell, m
  double volume(const Cell& cell) const;  ///< product of the free dimensions' widths
  double volume() const;                  ///< of all cells
  double weight(const Cell& cell) const;  ///< volume times the prior's density at the centre
  double weight() const;                  ///< of all cells

  /// Removes the cells that can't have given every one of some traces, or that `excludes` says so of. Returns whether
  /// any are left; if not, nothing is changed.
  bool update(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes = {});

  /// Splits cells, the coarsest first, as long as there is room for more, and tests the new ones against the whole
  /// history. False (and unchanged from there on) if that would leave none. Stops early when `enough` says so.
  bool refine(const Task& task, const std::vector<Trace>& history,
              const std::function<bool(const CellBelief&)>& enough = {});

  /// Whether each pose that may have given the history passes a test. `passes` is asked of cells and errs to false;
  /// those that fail are split, depth first, down to the finest, so that it takes no memory. Given up (false) after
  /// some `most_tests` of parts against the history. If true, cells of which nothing is left go; else nothing is
  /// changed.
  bool prove(const Task& task, const std::vector<Trace>& history, const std::function<bool(const Cell&)>& passes,
             std::size_t most_tests);

  Cell draw_cell(support::Rng& rng) const;  ///< by weight
  PoseVector draw_in(const Cell& cell, support::Rng& rng) const;

  /// About `count` parts of cells, each of at most `radius` (m), drawn by weight from all the parts of that size that
  /// may have given the history: cells are split, the parts tested, and again and again all but `count` of them left
  /// out by lot. Empty if none was met. Stops early, with coarser parts, once half of a budget in seconds is used up.
  std::vector<Cell> draw_parts(const Task& task, const std::vector<Trace>& history, std::size_t count, double radius,
                               support::Rng& rng, const support::Deadline& deadline) const;

  const std::optional<CellGrid>& grid() const { return grid_; }  ///< none once the cells are a list

  /// From the members of a grid, or from a list. Throws nothing: what they are must have been checked.
  static CellBelief restored(const Task& task, const CellOptions& options, Bitset members);
  static CellBelief restored(const Task& task, const CellOptions& options, std::vector<Cell> cells);

 private:
  bool may_split(const Cell& cell) const { return radius(cell) > options_.finest_radius; }
  void split(const Cell& cell, std::vector<Cell>& halves) const;
  double coarsest(const std::vector<Cell>& cells) const;
  std::vector<Cell> halves_of_coarsest(const Task& task, const std::vector<Trace>& history,
                                       const std::vector<Cell>& cells, std::size_t most) const;
  bool may_reproduce(const Task& task, const std::vector<Trace>& history, std::vector<std::size_t>& order,
                     Cell& cell) const;
  struct Rest;
  Rest rest_of(const Task& task, const std::vector<Trace>& history, const Cell& whole,
               const std::function<bool(const Cell&)>& passes, std::size_t most_tests,
               std::vector<std::size_t>& order) const;
  Cell any_cell(support::Rng& rng) const;
  std::vector<Cell> thinned(const std::vector<Cell>& cells, std::size_t count, support::Rng& rng) const;
  void list_when_few();
  void weigh();
  Cell draw_weighed(support::Rng& rng) const;

  CellOptions options_;
  scene::Prior prior_;
  double reach_ = 0.0;  ///< m from the target's origin to its farthest vertex
  PoseVector initial_half_{};
  std::optional<CellGrid> grid_;
  std::vector<Cell> cells_;  ///< without a grid
  /// Where the prior is not uniform: weight of the cells up to each one, or up to each word of the grid's members.
  std::vector<double> weighed_;
};

template <typename Visit>
void CellBelief::for_each(Visit&& visit) const {
  all_of([&](const Cell& cell) {
    visit(cell);
    return true;
  });
}

template <typename Test>
bool CellBelief::all_of(Test&& test) const {
  if (!grid_) return std::all_of(cells_.begin(), cells_.end(), test);
  return grid_->members().all_of([&](std::size_t member) { return test(Cell{grid_->centre(member), {}}); });
}

}  // namespace tactus::belief
