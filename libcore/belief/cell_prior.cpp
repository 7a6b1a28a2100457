// SPDX-License-Identifier: BSD-3-Clause
#include "belief/cell_prior.hpp"

#include <algorithm>

namespace tactus::belief {

CellPrior::CellPrior(const scene::Prior& prior, const CellFrame& frame) {
  std::vector<scene::PriorOverBoxes> by_splits;
  const std::size_t sizes = prior.guesses.empty() ? 1 : most_splits + 1;
  for (Cell cell; by_splits.size() < sizes; ++cell.splits[static_cast<std::size_t>(frame.widest(cell))])
    by_splits.emplace_back(prior, frame.half_width(cell));
  by_splits_ = std::make_shared<const std::vector<scene::PriorOverBoxes>>(std::move(by_splits));
}

double CellPrior::density(const Cell& cell) const {
  return (*by_splits_)[std::min(cell.all_splits(), by_splits_->size() - 1)].density(cell.centre);
}

}  // namespace tactus::belief
