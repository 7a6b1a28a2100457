// SPDX-License-Identifier: BSD-3-Clause
#include "scene/normal_over_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/prior.hpp"

namespace tactus::scene {
namespace {

constexpr double most_change = 1e30;  // by correlations

Matrix6 smeared(const Matrix6& covariance, const PoseVector& half) {
  Matrix6 wider = covariance;
  for (int d = 0; d < 6; ++d) wider(d, d) += half[d] * half[d] / 3.0;
  return wider;
}

/// The mean density of a unit normal from `at - half` to `at + half`. By the nearer tail, so that it is right far out
/// too.
double mean_between(double at, double half) {
  constexpr double narrow = 1e-5;
  if (half < narrow) return std::exp(-0.5 * at * at) / std::sqrt(2.0 * std::numbers::pi);
  const double near = (std::abs(at) - half) / std::numbers::sqrt2, far = (std::abs(at) + half) / std::numbers::sqrt2;
  return (std::erfc(near) - std::erfc(far)) / (4.0 * half);
}

}  // namespace

NormalOverBoxes::NormalOverBoxes(const Normal& normal, const PoseVector& half, const PoseVector& width)
    : half_(half), with_correlations_(normal.mean(), smeared(normal.covariance(), half), width) {
  for (int d = 0; d < 6; ++d) {
    is_free_[d] = width[d] > 0.0;
    deviation_[d] = std::sqrt(normal.covariance()(d, d));
    smeared_[d] = std::sqrt(with_correlations_.covariance()(d, d));
    if (is_free_[d]) independent_ /= std::sqrt(2.0 * std::numbers::pi) * smeared_[d];
  }
}

double NormalOverBoxes::mean_density(const PoseVector& centre) const {
  double mean = 1.0, squares = 0.0;
  for (int d = 0; d < 6; ++d) {
    if (!is_free_[d]) continue;
    const double at = with_correlations_.mean()[d];
    const double off = (d < 3 ? centre[d] : nearest_angle(centre[d], at)) - at;
    mean *= mean_between(off / deviation_[d], half_[d] / deviation_[d]) / deviation_[d];
    squares += off * off / (smeared_[d] * smeared_[d]);
  }
  if (!(mean > 0.0)) return 0.0;
  const double without = independent_ * std::exp(-0.5 * squares);
  return without > 0.0 ? mean * std::min(most_change, with_correlations_.density(centre) / without) : mean;
}

}  // namespace tactus::scene
