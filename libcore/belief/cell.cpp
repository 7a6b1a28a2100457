// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cell.hpp"

#include <cmath>

#include "scene/prior.hpp"

namespace tactus::belief {

PoseVector CellFrame::half_width(const Cell& cell) const {
  PoseVector widths = half;
  for (int d = 0; d < 6; ++d) widths[d] = std::ldexp(widths[d], -cell.splits[d]);
  return widths;
}

double CellFrame::radius(const Cell& cell) const { return scene::cell_radius(half_width(cell), reach); }

double CellFrame::volume(const Cell& cell) const {
  double product = 1.0;
  for (const double width : half_width(cell)) product *= width > 0.0 ? 2.0 * width : 1.0;
  return product;
}

int CellFrame::widest(const Cell& cell) const {
  const PoseVector widths = half_width(cell);
  int widest = 0;
  double most = -1.0;
  for (int d = 0; d < 6; ++d) {
    const double moves = d < 3 ? widths[d] : widths[d] * reach;
    if (moves > most) most = moves, widest = d;
  }
  return widest;
}

std::array<Cell, 2> CellFrame::halves(const Cell& cell) const {
  const int d = widest(cell);
  const double quarter = 0.5 * half_width(cell)[d];
  std::array<Cell, 2> parts{cell, cell};
  parts[0].centre[d] -= quarter;
  parts[1].centre[d] += quarter;
  for (Cell& part : parts) ++part.splits[d];
  return parts;
}

}  // namespace tactus::belief
