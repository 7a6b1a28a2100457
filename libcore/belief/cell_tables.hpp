// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "belief/cell_grid.hpp"
#include "contact/contact_tables.hpp"

namespace tactus::belief {

/// What a tool that stands on its sites does to the cells of a grid, from tables of contact: cells and sites share a
/// lattice. The tables are of the tool deflated by a cell's radius, so that every pose of a cell is touched where they
/// say so; they are made when first asked for. Any number of threads.
class CellTables {
 public:
  /// The sites for cells of this shape: at their centres, and evenly between them, at most `step` (m) apart.
  static action::ToolSites sites(const CellShape& shape, double step);

  /// `task` must outlive the tables, and have sites of this shape.
  CellTables(const Task& task, const CellShape& shape);

  const CellShape& shape() const { return shape_; }

  /// Whether they were made for a robot that may be off its waypoints by as much as a trace says.
  bool serves(const Trace& trace) const { return trace.error <= task_.options().sensing.encoder_error; }

  /// Drops from `members` the cells every pose of which is touched at a waypoint at which the tool was free and stood
  /// on a site. O(rows near the motion), and whatever the tables take to make.
  void sift(const Trace& trace, Bitset& members) const;

  /// What of a trace `sift` leaves to be asked otherwise: its contact, and the free waypoints at which the tool stands
  /// off its sites, or a link may be near the target. Without waypoints if there is nothing left to ask.
  Trace rest(const Trace& trace) const;

  std::size_t bytes() const { return touched_.bytes(); }

  /// As `contact::ContactTables::save` and `restore`.
  std::vector<std::uint8_t> save() const { return touched_.save(); }
  void restore(const std::uint8_t* bytes, std::size_t size) const { touched_.restore(bytes, size); }

 private:
  std::optional<contact::LatticePose> site(const Trace& trace, std::size_t waypoint) const;
  bool answers(const Trace& trace, std::size_t waypoint) const;

  const Task& task_;
  CellShape shape_;
  contact::ContactTables touched_;
  Pose lattice_from_base_;
};

}  // namespace tactus::belief
