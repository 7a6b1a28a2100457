// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "belief/cell.hpp"
#include "scene/prior.hpp"

namespace tactus::belief {

/// What a prior says of cells: how often a cell was split says how large it is. Copies share.
class CellPrior {
 public:
  CellPrior() = default;
  CellPrior(const scene::Prior& prior, const CellFrame& frame);

  /// The mean of the prior's density over a cell.
  double density(const Cell& cell) const;

 private:
  std::shared_ptr<const std::vector<scene::PriorOverBoxes>> by_splits_;
};

}  // namespace tactus::belief
