// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "belief/cells.hpp"

namespace tactus::belief {

/// A part of a belief that hangs together: between it and the others lies at least the width of the coarsest cell in
/// which the target can't be, or is a thousand times less likely. A socket that looks alike at four rolls has four.
struct Mode {
  double mass = 0.0;    ///< its share of the belief's weight; those of all modes sum to one
  PoseVector mean{};    ///< of the target's pose; angles: circular mean
  PoseVector extent{};  ///< full widths
};

/// The heaviest first. O(cells).
std::vector<Mode> modes_of(const CellBelief& cells, const scene::Prior& prior);

}  // namespace tactus::belief
