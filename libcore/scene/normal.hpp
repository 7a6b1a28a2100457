// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "geometry/pose.hpp"
#include "support/rng.hpp"

namespace tactus::scene {

using geometry::PoseVector;

/// Over x, y, z (m), roll, pitch, yaw (rad).
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// A pose that is roughly known: normally distributed about a mean in the dimensions of a box that are free, those
/// whose width is not 0. An angle is never more than half a turn off the mean: the distribution ends there.
class Normal {
 public:
  /// `covariance` must be one (`is_covariance`). Nothing that it or the mean says of the other dimensions counts.
  Normal(const PoseVector& mean, const Matrix6& covariance, const PoseVector& width);

  static constexpr double least_deviation = 1e-6, greatest_deviation = 1e3;  ///< m and rad

  /// Whether the matrix is positive definite in the free dimensions, with deviations within these bounds, and its
  /// correlations are not within 1e-9 of being singular. Only what is on and below the diagonal is looked at.
  static bool is_covariance(const Matrix6& matrix, const PoseVector& width);

  const PoseVector& mean() const { return mean_; }
  const Matrix6& covariance() const { return covariance_; }

  /// Per metre and radian of every free dimension, as if the ends at half a turn were not; angles modulo whole turns.
  double density(const PoseVector& pose) const;

  /// Draws once: nothing if an angle comes to lie more than half a turn off the mean.
  std::optional<PoseVector> draw(support::Rng& rng) const;

 private:
  PoseVector mean_;
  Matrix6 covariance_;
  Matrix6 factor_;     ///< from independent unit normals to the free dimensions, and
  Matrix6 whitening_;  ///< back; both are 0 in the others
  double peak_ = 1.0;  ///< density at the mean
};

}  // namespace tactus::scene
