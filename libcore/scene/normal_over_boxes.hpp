// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scene/normal.hpp"

namespace tactus::scene {

/// A normal distribution as boxes of one size see it.
class NormalOverBoxes {
 public:
  /// Boxes of half the widths `half`, > 0 in the dimensions that are free: those whose `width` is not 0.
  NormalOverBoxes(const Normal& normal, const PoseVector& half, const PoseVector& width);

  /// The mean of the density over the box about `centre`. Exact where dimensions are independent. What correlations
  /// change is taken from normals that are smeared over the box (covariance + diag(half^2 / 3)), at its centre: nothing
  /// where the box is much wider than the normal, and what they change of the density where it is much narrower.
  double mean_density(const PoseVector& centre) const;

 private:
  PoseVector half_, deviation_, smeared_;  ///< deviations by dimension; smeared over the box
  std::array<bool, 6> is_free_{};
  double independent_ = 1.0;  ///< density at the mean of the smeared normal without correlations
  Normal with_correlations_;  ///< smeared
};

}  // namespace tactus::scene
