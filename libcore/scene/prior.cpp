// SPDX-License-Identifier: BSD-3-Clause
#include "scene/prior.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tactus::scene {

Pose Prior::sample(support::Rng& rng) const {
  PoseVector v = centre;
  for (int d = 0; d < 6; ++d) v[d] += width[d] * (rng.uniform() - 0.5);
  return geometry::pose_from(v);
}

bool Prior::contains(const PoseVector& pose, double tolerance) const {
  for (int d = 0; d < 6; ++d) {
    const double value = d < 3 ? pose[d] : nearest_angle(pose[d], centre[d]);
    if (!(std::abs(value - centre[d]) <= 0.5 * width[d] + tolerance)) return false;
  }
  return true;
}

double nearest_angle(double angle, double to) {
  constexpr double turn = 2.0 * std::numbers::pi;
  return angle - turn * std::round((angle - to) / turn);
}

double cell_radius(const PoseVector& half, double reach) {
  double radius = std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]);
  for (int d = 3; d < 6; ++d) radius += 2.0 * std::sin(0.5 * std::min(half[d], std::numbers::pi)) * reach;
  return radius;
}

}  // namespace tactus::scene
