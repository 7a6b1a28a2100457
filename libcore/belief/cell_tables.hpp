// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "belief/cell_grid.hpp"
#include "contact/contact_tables.hpp"

namespace tactus::belief {

/// What a tool that stands on its sites does to the cells of a grid, from tables of contact: they share a lattice.
/// There are tables of the tool deflated by a cell's radius (every pose of the cell is touched) and inflated by it
/// (some may be), made when first asked for. Any number of threads.
class CellTables {
 public:
  /// The sites for cells of this shape: at their centres, and evenly between them, at most `step` (m) apart.
  static action::ToolSites sites(const CellShape& shape, double step);

  /// `task` must outlive the tables, and have sites of this shape.
  CellTables(const Task& task, const CellShape& shape);

  const CellShape& shape() const { return shape_; }

  /// Drops from `members` the cells that a trace tells nothing can be in, as far as the tables know: those of which
  /// every pose is touched where the tool was free, on a site; and those of which none can be touched where it was
  /// stopped, at most half a step from one. O(rows near the motion), and whatever the tables take to make.
  void sift(const Trace& trace, Bitset& members) const;

  /// What of a trace `sift` leaves to be asked otherwise: the free waypoints at which the tool stands off its sites, or
  /// a link may be near the target, and the touch if it was far from one. Without waypoints if that is nothing.
  Trace rest(const Trace& trace) const;

  std::size_t bytes() const { return surely_.bytes() + perhaps_.bytes(); }

  /// The tables made so far, as bytes; and taken in again. Throws as `contact::ContactTables::restore`, and then
  /// nothing has changed.
  std::vector<std::uint8_t> save() const;
  void restore(const std::uint8_t* bytes, std::size_t size) const;

 private:
  std::optional<contact::LatticePose> site(const Trace& trace, std::size_t waypoint, double within) const;
  std::vector<contact::LatticePose> free_sites(const Trace& trace) const;
  std::vector<contact::LatticePose> touch_sites(const Trace& trace) const;
  bool links_near(const Trace& trace, std::size_t waypoint) const;
  template <typename Visit>
  void for_each_touched(const contact::ContactTables& tables, std::vector<contact::LatticePose> sites,
                        Visit&& visit) const;

  const Task& task_;
  CellShape shape_;
  contact::Lattice lattice_;
  Pose lattice_from_base_;
  double near_site_;  ///< m that a point of the tool may be off where it would be on a site, when it touches
  contact::ContactTables surely_, perhaps_;
};

}  // namespace tactus::belief
