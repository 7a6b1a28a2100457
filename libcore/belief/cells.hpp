// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <optional>

#include "belief/cell.hpp"
#include "belief/cell_prior.hpp"
#include "belief/cell_tables.hpp"
#include "belief/projection.hpp"

namespace tactus::belief {

/// Radii (m) of parts of cells: one that tells most of what touches it, and one any pose of which agrees with the
/// history as far as planning can use.
inline constexpr double part_radius = 0.0015, fine_radius = 0.0004;

/// Share of a planning call's budget in seconds after which drawing poses ends: planning needs the rest.
inline constexpr double latest_draw = 0.4;

struct CellOptions {
  double position = 0.004;               ///< initial full width, m
  double angle = 0.06;                   ///< initial full width, rad
  std::size_t most = 20000;              ///< cells are split while there are fewer; ten times that for `look_inside`
  std::size_t most_at_first = 1u << 21;  ///< initial cells are widened until there are no more than these
  double finest_radius = 0.00025;        ///< m: no cell with a smaller radius is split
  /// Looks of the contact engine after which one `refine` ends, or a little later; the next goes on where it was.
  std::uint64_t most_looks = 2'500'000;
  std::shared_ptr<const CellTables> tables{};  ///< used while the cells are those of their grid; null: none
  int threads = 1;  ///< that test cells; 0: as many as the machine has. The answers are the same
};

/// What looking into cells came to.
enum class Looked { gave_up, none, all };

/// Phase 2: a set of cells that covers every pose that may have given the observations. A cell goes only when no pose
/// in it can have. As long as there are many they are those of a grid; then a list, in which they are split. They weigh
/// what the prior says: that counts where cells are drawn or described, and removes none. A value.
class CellBelief {
 public:
  using Excludes = CellGrid::Excludes;

  /// All cells of the prior.
  CellBelief(const Task& task, const CellOptions& options);

  /// Of all cells of the prior.
  static CellShape shape(const scene::Prior& prior, const CellOptions& options);

  std::size_t size() const { return grid_ ? grid_->size() : cells_.size(); }
  std::vector<Cell> cells() const;  ///< O(cells), as the two below
  template <typename Visit>
  void for_each(Visit&& visit) const;
  /// `visit(cell, half_width, weight)`, by what all cells of a grid have in common.
  template <typename Visit>
  void for_each_weighed(Visit&& visit) const;
  template <typename Test>
  bool all_of(Test&& test) const;

  PoseVector half_width(const Cell& cell) const { return frame_.half_width(cell); }
  double radius(const Cell& cell) const { return frame_.radius(cell); }  ///< m, as in `CellFrame`
  double coarsest() const;                                               ///< radius of the coarsest cell, m
  double volume(const Cell& cell) const { return frame_.volume(cell); }
  double volume() const;                        ///< of all cells
  double weight(const Cell& cell) const;        ///< volume times the prior's mean density, less its bits
  double weight() const;                        ///< of all cells
  bool is_uniform() const { return !weighs_; }  ///< they weigh as much as their volume

  /// Removes the cells that can't have given every one of some traces, or that `excludes` says so of. Returns whether
  /// any are left; if not, nothing is changed.
  bool update(const Task& task, const std::vector<const Trace*>& traces, const Excludes& excludes = {});

  /// Splits cells that are not `fine`, the coarsest first, as long as there is room for more, and tests the new ones
  /// against the whole history. False (and unchanged from there on) if that would leave none. Ends after
  /// `CellOptions::most_looks`: the next observation may leave fewer cells to split.
  bool refine(const Task& task, const std::vector<Trace>& history, const std::function<bool(const Cell&)>& fine);

  /// Looks into the cells, depth first, so that it takes no more room than what is found: they are split until they are
  /// `fine`, and the parts tested against the whole history. Cells of which nothing is left go, the others are replaced
  /// by their parts as long as there is room. `all`: every pose that may have given the history lies in a part that is
  /// fine, which proves whatever can be asked of a cell. `none`: no pose may have given it; then nothing is changed.
  /// `gave_up`: a part of 0.02 mm is not fine, the cells are too many, or it took some `most_looks` of the contact
  /// engine. What was found by then is kept as far as there is room for more cells, so that the next one goes on.
  Looked look_inside(const Task& task, const std::vector<Trace>& history, const std::function<bool(const Cell&)>& fine,
                     std::uint64_t most_looks);

  /// How many looks of the contact engine it would take to look for parts of at most `radius` (m), by what some cells
  /// take. Where it would be more than `most`, some number above that.
  double estimated_looks(const Task& task, const std::vector<Trace>& history, double radius, double most,
                         support::Rng& rng) const;

  Cell draw_cell(support::Rng& rng) const;  ///< by weight
  PoseVector draw_in(const Cell& cell, support::Rng& rng) const;

  /// About `count` parts of cells, each of at most `radius` (m; it may be finer than cells are split), drawn by weight
  /// from all the parts of that size that may have given the history: cells are split, the parts tested, and again and
  /// again all but `count` of them left out by lot. Empty if none was met. Stops early, with coarser parts, after
  /// `latest_draw`. Throws `Cancelled`.
  std::vector<Cell> draw_parts(const Task& task, const std::vector<Trace>& history, std::size_t count, double radius,
                               support::Rng& rng,
                               const support::Deadline& deadline = support::Deadline::unlimited()) const;

  const std::optional<CellGrid>& grid() const { return grid_; }  ///< none once the cells are a list

  /// From the members of a grid, or from a list. Throws nothing: what they are must have been checked.
  static CellBelief restored(const Task& task, const CellOptions& options, Bitset members);
  static CellBelief restored(const Task& task, const CellOptions& options, std::vector<Cell> cells);

  /// A list of cells that `WeighedCells` gave: their splits are of the prior as one cell. It is not to be updated.
  static CellBelief weighed(const Task& task, const CellOptions& options, std::vector<Cell> cells);

 private:
  double coarsest(const std::vector<Cell>& cells) const;
  bool any_coarser(const std::vector<Cell>& cells, double wanted) const;
  std::vector<Cell> halves_of_coarsest(const Task& task, const std::vector<Trace>& history,
                                       const std::vector<Cell>& cells, std::size_t most, double finest,
                                       Effort* effort = nullptr, const support::Cancellation& cancellation = {}) const;
  bool may_reproduce(const Task& task, const std::vector<Trace>& history, std::vector<std::size_t>& order,
                     const Cell& cell, Effort& effort) const;
  struct Inside;
  Inside inside(const Task& task, const std::vector<Trace>& history, const Cell& whole,
                const std::function<bool(const Cell&)>& fine, std::uint64_t most_looks) const;
  void replace(const std::vector<Cell>& wholes, const std::vector<Inside>& found, std::size_t room);
  std::vector<Cell> by_lot(std::size_t count, support::Rng& rng) const;
  Cell any_cell(support::Rng& rng) const;
  std::vector<Cell> thinned(const std::vector<Cell>& cells, std::size_t count, support::Rng& rng) const;
  void list_when_few();
  void weigh();
  Cell draw_weighed(support::Rng& rng) const;

  CellOptions options_;
  scene::Prior prior_;
  CellFrame frame_;
  CellPrior density_;
  std::optional<CellGrid> grid_;
  std::vector<Cell> cells_;  ///< without a grid
  bool weighs_ = false;      ///< not by volume alone
  /// Weight of the cells of the list up to each one, or up to each word of the grid's members; empty where those weigh
  /// the same.
  std::vector<double> weighed_;
};

template <typename Visit>
void CellBelief::for_each(Visit&& visit) const {
  all_of([&](const Cell& cell) {
    visit(cell);
    return true;
  });
}

template <typename Visit>
void CellBelief::for_each_weighed(Visit&& visit) const {
  const Cell whole;
  const double usual = frame_.volume(whole);
  for_each([&](const Cell& cell) {
    const double weighs = weighs_ ? weight(cell) : grid_ ? usual : volume(cell);
    if (grid_)
      visit(cell, frame_.half, weighs);
    else
      visit(cell, half_width(cell), weighs);
  });
}

template <typename Test>
bool CellBelief::all_of(Test&& test) const {
  if (!grid_) return std::all_of(cells_.begin(), cells_.end(), test);
  return grid_->members().all_of([&](std::size_t member) { return test(Cell{grid_->centre(member), {}}); });
}

}  // namespace tactus::belief
